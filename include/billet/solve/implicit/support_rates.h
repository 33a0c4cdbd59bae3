// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_SUPPORT_RATES_H
#define BILLET_SOLVE_IMPLICIT_SUPPORT_RATES_H

#include "billet/discretization/supports.h"

namespace billet {

/// Velocities and accelerations that supports prescribe, by differences over a step; other
/// components are 0.
class SupportRates {
public:
  SupportRates(const Scene &scene, const Discretization &discretization, const Supports &supports);

  struct Rates {
    Vector velocity, acceleration;
  };
  const Rates &at_start() const { return start_; }
  const Rates &at_end() const { return end_; }
  /// Returns the change of the prescribed displacements in the step.
  const Vector &change() const { return change_; }

  /// Starts at time t; `step` is the length over which differences are taken.
  void start(double t, double step);
  void start_step(double t_n, double t);
  /// Replaces the components that supports prescribe.
  void prescribe(const Vector &held, Vector &rate) const;
  void commit() { start_ = end_; }
  /// Sets saved rates at the start of the step.
  void set_start(const Rates &rates) { start_ = end_ = rates; }

private:
  Rates find(double t, double step) const;
  Vector change(double from, double to) const;

  const Scene &scene_;
  const Discretization &discretization_;
  const Supports &supports_;
  Rates start_, end_;
  Vector change_;
};

} // namespace billet

#endif
