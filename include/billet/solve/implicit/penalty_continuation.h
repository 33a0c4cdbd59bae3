// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_PENALTY_CONTINUATION_H
#define BILLET_SOLVE_IMPLICIT_PENALTY_CONTINUATION_H

#include "billet/solve/implicit/equilibrium_solver.h"

#include <vector>

namespace billet {

/// Recovery of a static step in which Newton's method fails with stiff penalties: softer ones lead to them.
/// In dynamics inertia, and shorter steps, do the same.
class PenaltyContinuation {
public:
  PenaltyContinuation(ImplicitProblem &problem, EquilibriumSolver &solver)
      : problem_(problem), solver_(solver) {}

  /// Whether penalties are above 10 E/h, so that softer ones may lead to them. Collective.
  bool is_possible() const;
  /// As EquilibriumSolver::iterate(), with penalties of 10 E/h first, which then grow to what they are.
  NewtonReport iterate(std::vector<double> &offsets, Vector &displacements);
  /// Warning that a step needed that. Collective.
  Diagnostic describe() const;

private:
  /// How penalties grow, in octaves, factors of 2.
  struct Limits {
    static constexpr int first_stride = 3;
    static constexpr unsigned int max_retreats = 4; ///< to strides of one octave
  };
  /// By how many octaves the penalties of a contact are stiffer than 10 E/h.
  struct Octaves {
    int normal = 0, tangential = 0;
  };
  /// Of each contact. Collective.
  std::vector<Octaves> octaves_above_enough() const;
  /// Changes penalties that are `softer` octaves below what they are, to be `octaves` below.
  void soften(const std::vector<Octaves> &above, int softer, int octaves);

  ImplicitProblem &problem_;
  EquilibriumSolver &solver_;
};

} // namespace billet

#endif
