// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_RUN_REVIEW_H
#define BILLET_SOLVE_RUN_REVIEW_H

#include "billet/solve/contact_review.h"
#include "billet/solve/element_watch.h"
#include "billet/solve/inertia_watch.h"
#include "billet/solve/missing_pairs.h"
#include "billet/solve/unbalanced_bodies.h"

namespace billet {

/// Reviews a run by its accepted steps, for both kinds of schemes. It checks whether the scene is
/// plausible and complete, and whether its elements, contact and steps are fine enough.
class RunReview {
public:
  RunReview(const Scene &scene, const Discretization &discretization);

  /// Returns diagnostics before the first step. Collective.
  DiagnosticList start() const;
  /// Returns diagnostics after an accepted step; in explicit scenes a step now and then.
  /// Collective.
  DiagnosticList after_step(const Solution &solution, bool is_last);
  /// Returns diagnostics after the last step. Collective.
  DiagnosticList finish() const;

  /// Returns the largest kinetic energy of the run over the largest internal energy. It is small in
  /// a quasi-static process.
  double kinetic_part() const { return max_internal_ > 0. ? max_kinetic_ / max_internal_ : 0.; }

  /// Returns the relative error of forces by elements that are too stiff or too soft; 0 if none is
  /// found.
  double element_error() const { return elements_.error(); }

  /// Returns the part by which penetration makes forces too small; 0 if it is small.
  double penalty_error() const { return contacts_.penalty_error(); }

  /// Returns why errors of the mesh are unknown: elements are too stiff or too soft, or it does not
  /// resolve the contact. Empty if nothing is known against it.
  std::string describe_unresolved() const {
    return elements_.error() > 0. ? "elements are too stiff or too soft, as a warning says"
                                  : contacts_.describe_unresolved();
  }

  /// Whether any surface has touched itself.
  bool self_contact_touches() const { return contacts_.self_contact_touches(); }

  void save(StateWriter &writer) const;
  /// Loads the review; it starts from zero if the earlier run did not save it.
  void load(StateReader &reader);

private:
  const Scene &scene_;
  const Discretization &discretization_;
  ElementWatch elements_;
  InertiaWatch inertia_;
  ContactReview contacts_;
  MissingPairs missing_pairs_;
  UnbalancedBodies unbalanced_;
  double max_kinetic_ = 0., max_internal_ = 0.,
         max_energy_ = 0.; ///< max_energy_: total
  double numerical_ = 0.;  ///< dissipated by implicit time integration so far
  double viscous_ = 0.;    ///< dissipated by bulk viscosity so far
};

} // namespace billet

#endif
