// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_PENALTY_CONTINUATION_H
#define BILLET_SOLVE_IMPLICIT_PENALTY_CONTINUATION_H

#include "billet/solve/implicit/equilibrium_solver.h"

#include <vector>

namespace billet {

/// Recovery of a step in which Newton's method fails with high penalties: continuation from lower ones.
/// StepRules::may_continue_penalties() says whether a scheme uses it.
class PenaltyContinuation {
public:
  PenaltyContinuation(ImplicitProblem &problem, EquilibriumSolver &solver)
      : problem_(problem), solver_(solver) {}

  /// Whether penalties are above 10 E/h, so that lower ones may lead to them. Collective.
  bool is_possible() const;
  /// Iterates like EquilibriumSolver::iterate(), with penalties of 10 E/h first, which then rise to their
  /// values.
  NewtonReport iterate(std::vector<double> &offsets, Vector &displacements);
  /// Returns a warning that a step needed continuation. Collective.
  Diagnostic describe() const;

private:
  /// Growth of penalties, in octaves, factors of 2.
  struct Limits {
    static constexpr int first_stride = 3;
    static constexpr unsigned int max_retreats = 4; ///< to strides of one octave
  };
  /// Number of octaves by which the penalties of a contact exceed 10 E/h.
  struct Octaves {
    int normal = 0, tangential = 0;
  };
  /// Returns the octaves of each contact. Collective.
  std::vector<Octaves> octaves_above_enough() const;
  /// Changes penalties from `softer` octaves below their values to `octaves` below them.
  void soften(const std::vector<Octaves> &above, int softer, int octaves);

  ImplicitProblem &problem_;
  EquilibriumSolver &solver_;
};

} // namespace billet

#endif
