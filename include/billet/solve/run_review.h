// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_RUN_REVIEW_H
#define BILLET_SOLVE_RUN_REVIEW_H

#include "billet/solve/contact_review.h"
#include "billet/solve/element_watch.h"
#include "billet/solve/inertia_watch.h"
#include "billet/solve/missing_pairs.h"

namespace billet {

/// Judges a run by its accepted steps: whether its scene is plausible and complete, its elements, contact
/// and steps fine enough.
/// All in one place, for both kinds of schemes.
class RunReview {
public:
  RunReview(const Scene &scene, const Discretization &discretization);

  /// Before the first step. Collective.
  DiagnosticList start() const;
  /// After an accepted step; of explicit scenes now and then. Collective.
  DiagnosticList after_step(const Solution &solution, bool is_last);
  /// After the last one. Collective.
  DiagnosticList finish() const;

  /// Largest kinetic energy of the run over the largest internal energy, of deformation; a process is
  /// quasi-static where that is small.
  double kinetic_part() const { return largest_internal_ > 0. ? largest_kinetic_ / largest_internal_ : 0.; }

  /// By what part forces are too large since elements are too stiff; 0 where none is found so.
  double element_error() const { return elements_.error(); }

  /// By what part forces are too small since penetration takes it; 0 where that is little.
  double penalty_error() const { return contacts_.penalty_error(); }

  void save(StateWriter &writer) const;
  /// Of a run that kept no such account it begins anew.
  void load(StateReader &reader);

private:
  const Scene &scene_;
  const Discretization &discretization_;
  ElementWatch elements_;
  InertiaWatch inertia_;
  ContactReview contacts_;
  MissingPairs missing_pairs_;
  double largest_kinetic_ = 0., largest_internal_ = 0.,
         largest_energy_ = 0.; ///< the last: of all that counts
  double numerical_ = 0.;      ///< dissipated by implicit time integration until the last step
};

} // namespace billet

#endif
