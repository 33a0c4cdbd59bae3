// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_PENALTY_CONTINUATION_H
#define BILLET_SOLVE_IMPLICIT_PENALTY_CONTINUATION_H

#include "billet/solve/implicit/equilibrium_solver.h"

#include <utility>
#include <vector>

namespace billet {

/// Recovery of a step in which Newton's method fails: continuation from lower penalties.
/// StepRules::may_continue_penalties() says whether a scheme uses it. Penalties above 10 E/h may be
/// too high for any body. Those of E/h are too high for a thin sheet, which bends much more easily
/// than it compresses. Nodes along it then touch and open in turn.
class PenaltyContinuation {
public:
  PenaltyContinuation(ImplicitProblem &problem, EquilibriumSolver &solver)
      : problem_(problem), solver_(solver) {}

  /// Penalties of the start.
  enum class Start {
    enough, ///< 10 E/h
    low     ///< E/h / 820, at which bricks with a fifth of the length in thickness bend as easily
  };

  /// Whether penalties are above those of the start, so that lower ones may lead to them. Low ones
  /// also have to be permitted. Collective.
  bool is_possible(Start start = Start::enough) const;
  /// Permits low penalties, a last resort. A long step by them may lead to another equilibrium than
  /// short ones, such as that of nodes which have slid off an edge. Returns whether they were not
  /// permitted before.
  bool permit_low() { return !std::exchange(permits_low_, true); }
  void forbid_low() { permits_low_ = false; }
  /// Iterates like EquilibriumSolver::iterate(), with the penalties of the start first, which then
  /// rise to their values.
  NewtonReport iterate(Start start, std::vector<double> &offsets, Vector &displacements);
  /// Returns a warning that a step needed continuation. Collective.
  Diagnostic describe() const;

private:
  /// Growth of penalties, in octaves, factors of 2.
  struct Limits {
    static constexpr int first_stride = 3;
    static constexpr unsigned int max_retreats = 4; ///< to strides of one octave
    static constexpr int low = 13;                  ///< octaves from 10 E/h to low penalties
  };
  /// Number of octaves by which the penalties of a contact exceed those of the start.
  struct Octaves {
    int normal = 0, tangential = 0;
  };
  /// Returns the octaves of each contact. Collective.
  std::vector<Octaves> octaves_above(Start start) const;
  /// Changes penalties from `softer` octaves below their values to `octaves` below them.
  void soften(const std::vector<Octaves> &above, int softer, int octaves);

  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
  EquilibriumSolver &solver_;
  bool permits_low_ = false;
};

} // namespace billet

#endif
