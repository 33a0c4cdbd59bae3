// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_CONTACT_DAMPING_H
#define BILLET_SOLVE_IMPLICIT_CONTACT_DAMPING_H

#include "billet/integration/time_integrator.h"
#include "billet/solve/implicit/contact_weights.h"
#include "billet/solve/implicit/free_mass.h"

namespace billet {

/// Weights of contact in implicit dynamics. In damped steps, those of (I4), the accelerations of
/// iterations are a*, without contact at both ends.
class ContactDamping final : public ContactWeights {
public:
  /// `accelerations` are those at the start of the step. The arguments must outlive this object.
  ContactDamping(const FreeMass &mass, const TimeIntegrator &integrator, const Vector &accelerations);

  /// Continues damping, once it is on, until contacts have opened.
  void choose(const ForceState &start) override;
  /// Makes the next steps those of (I4), in which contact cannot generate energy.
  void damp(const ForceState &start) override;
  double at_end() const override { return is_on_ ? integrator_.contact() : 1.; }
  double at_start() const override { return is_on_ ? 0. : 0.5; }
  bool is_on() const { return is_on_; }

  /// Sets −F_c at the end of a damped step, before complete(). Collective.
  void finish(const Vector &contact_forces);
  /// Returns a_n; with (I4), that of the other forces.
  const Vector &start_accelerations() const { return is_on_ ? without_contact_ : accelerations_; }
  /// Returns F_n of the residual: all forces; with (I4), without contact.
  const Vector &start_forces() const { return forces_n_; }
  /// Turns the accelerations of iterations at the end of the step into those of all forces.
  void complete(Vector &accelerations) const;

private:
  const FreeMass &mass_;
  const TimeIntegrator &integrator_;
  const Vector &accelerations_;
  bool is_on_ = false;
  Vector at_end_;          ///< c of (I4) at the end of the step
  Vector without_contact_; ///< a_n
  Vector forces_n_;
};

} // namespace billet

#endif
