// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_RESULTANT_GUARD_H
#define BILLET_SOLVE_IMPLICIT_RESULTANT_GUARD_H

#include "billet/solve/implicit/implicit_reactions.h"

#include <vector>

namespace billet {

/// Compares what residuals leave out of balance on each body with the forces of its supports and
/// contact pairs, (Q4) of doc/theory. 'Force tolerance' is a part of all nodal forces. Those of
/// bending are large beside the forces that bend, so that the latter need a smaller residual.
class ResultantGuard {
public:
  /// Part of the forces along an axis that may be out of balance.
  static constexpr double allowed = 0.01;

  explicit ResultantGuard(const ImplicitProblem &problem);

  /// Returns the largest part, over bodies and axes, that the last residual leaves out of balance.
  /// Collective.
  double find_part();
  /// Whether the next unbalanced step is worth further iterations: where they have failed, some
  /// steps go without.
  bool is_hopeful() const { return n_left_out_ == 0; }
  void note(bool is_balanced) { has_failed_ = !is_balanced; }
  /// Accepts the step of the last find_part().
  void commit();

  void save(StateWriter &writer) const;
  void load(StateReader &reader);

private:
  /// Largest forces on a body so far, along each axis, and the largest sum of its nodal forces
  /// [force].
  using OfBody = std::array<double, 4>;

  const ImplicitProblem &problem_;
  const ImplicitParts &parts_ = problem_.parts();
  ImplicitReactions reactions_;
  std::vector<std::size_t> bodies_of_supports_; ///< in the order of named_supports()
  std::vector<double> round_off_;               ///< by body [force]
  std::vector<OfBody> largest_, trial_;         ///< by body; `trial_`: of the last find_part(), too
  bool has_failed_ = false;                     ///< in this step
  unsigned int n_failed_ = 0, n_left_out_ = 0;  ///< failures in a row, and steps to go without
};

} // namespace billet

#endif
