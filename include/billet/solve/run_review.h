// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_RUN_REVIEW_H
#define BILLET_SOLVE_RUN_REVIEW_H

#include "billet/solve/contact_review.h"
#include "billet/solve/element_watch.h"

namespace billet {

/// Judges a run by its accepted steps: whether its scene is plausible, its elements and contact fine enough.
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

  /// By what part forces are too large since elements are too stiff; 0 where none is found so.
  double element_error() const { return elements_.error(); }

  void save(StateWriter &writer) const;
  /// Of a run that kept no such account it begins anew.
  void load(StateReader &reader);

private:
  const Scene &scene_;
  const Discretization &discretization_;
  ElementWatch elements_;
  ContactReview contacts_;
};

} // namespace billet

#endif
