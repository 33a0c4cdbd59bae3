// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_ROUND_OFF_GUARD_H
#define BILLET_SOLVE_IMPLICIT_ROUND_OFF_GUARD_H

#include "billet/solve/implicit/implicit_problem.h"
#include "billet/solve/round_off_watch.h"

namespace billet {

/// Judges the effect of round-off on the forces: of displacements, and of positions if penalties
/// are high.
class RoundOffGuard {
public:
  explicit RoundOffGuard(const ImplicitProblem &problem)
      : problem_(problem), is_balanced_by_inertia_(parts_.scheme().has_inertia()) {}

  /// Returns a failure of a converged step if round-off of contact is too large a part of the
  /// forces. This must be so in several such steps in succession, or at the end of the run.
  std::optional<StepFailure> judge(double t, const NewtonReport &report) const;
  /// Whether round-off of contacts may explain the residual of a failed step. Collective.
  bool may_explain(const NewtonReport &report) const;
  /// Explains the failure of a step in which round-off is this part of the forces. Collective.
  Explanation describe(double part) const;
  /// Accepts the step to t.
  void commit(double t, const NewtonReport &report);

  /// Returns a message if round-off limited the accepted residual to this part of the forces, above
  /// the tolerance. `accuracy`: see EquilibriumSolver.
  DiagnosticList check(double part, double accuracy) const;
  /// Returns a message at the end about round-off of contact penalties, relative to the largest
  /// forces of the run.
  DiagnosticList finish() const;

  void save(StateWriter &writer) const { writer.write("round-off", watch_.save()); }
  void load(const StateReader &reader) { watch_.load(reader.read("round-off")); }

private:
  struct Limits {
    /// Maximum number of successive steps limited by round-off. When loads begin, or nodes lie on a
    /// tool to the last bit, forces are small and soon grow.
    static constexpr unsigned int max_lost_steps = 3;
    /// Part of the round-off of bodies below which they have no other forces.
    static constexpr double unloaded = 0.1;
  };

  const ImplicitProblem &problem_;
  const ImplicitParts &parts_ = problem_.parts();
  const bool is_balanced_by_inertia_; ///< inertia balances a residual of round-off
  RoundOffWatch watch_;
  unsigned int n_lost_ = 0; ///< number of the last accepted steps that round-off limited
};

} // namespace billet

#endif
