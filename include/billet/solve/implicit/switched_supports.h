// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_SWITCHED_SUPPORTS_H
#define BILLET_SOLVE_IMPLICIT_SWITCHED_SUPPORTS_H

#include "billet/discretization/supports.h"
#include "billet/solve/restart.h"

#include <vector>

namespace billet {

/// Supports that begin and end between steps. The forces by which they held the bodies become dead forces on
/// their nodes, and fade.
class SwitchedSupports {
public:
  SwitchedSupports(const Scene &scene, const Discretization &discretization)
      : scene_(scene), discretization_(discretization), supports_(scene, discretization) {}

  const Supports &get() const { return supports_; }
  /// Whether the set of supports changes after t.
  bool is_due(const double t) const { return supports_.acting().differ(holding_after(t)); }
  /// Lets supports go and takes others as they are due at t. `reactions`: sum of all forces on the bodies,
  /// without constraints, with the sign of the residual. Returns the part of them that the supports that
  /// ended have borne and that remains at t; no constraint bears it any more. Collective.
  Vector switch_supports(double t, const Vector &reactions, const Vector &displacements);

  /// Whether the fading forces differ between t and t_n.
  bool changes(double t_n, double t) const;
  /// Subtracts the fading forces at t from the residual.
  void add_forces(double t, Vector &residual) const;
  /// Returns their work from t_n to t.
  double work(double t_n, double t, const Vector &increment) const;

  void save(StateWriter &writer, const OwnedNodes &nodes) const;
  /// Takes the supports that act after t. Those of which the state does not know where their nodes were hold
  /// them at these `displacements` (relevant dofs). Collective.
  void load(const StateReader &reader, const OwnedNodes &nodes, double t, const Vector &displacements);

private:
  struct Fading {
    FadeTimes times;
    Vector forces; ///< on the bodies
  };

  const Scene &scene_;
  const Discretization &discretization_;
  Supports supports_;
  std::vector<Fading> fading_;
};

} // namespace billet

#endif
