// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_ROUND_OFF_GUARD_H
#define BILLET_SOLVE_IMPLICIT_ROUND_OFF_GUARD_H

#include "billet/solve/implicit/implicit_problem.h"
#include "billet/solve/round_off_watch.h"

#include <string>

namespace billet {

/// Judges what round-off leaves of the forces: of displacements, and of positions where penalties are stiff.
class RoundOffGuard {
public:
  explicit RoundOffGuard(const ImplicitProblem &problem) : problem_(problem) {}

  /// Whether a step that has converged has to fail, since contact's round-off leaves too much of the forces
  /// in it, as in those before it, or in the last of the run.
  bool rejects(double t, NewtonReport &report) const;
  /// Whether round-off of contacts may be as large as what is left in a failed step. Collective.
  bool may_explain(const NewtonReport &report) const;
  /// Reason of a step that is lost in round-off, which leaves this part of the forces. Collective.
  std::string describe(double part) const;
  /// Accepts the step to t.
  void commit(double t, const NewtonReport &report);

  /// A message if the step was accepted with this part of the forces, more than the tolerance, since
  /// round-off lets it come no nearer. `accuracy`: see EquilibriumSolver.
  DiagnosticList check(double part, double accuracy) const;
  /// At the end: what round-off of contact's penalties is beside the largest forces of the run.
  DiagnosticList finish() const;

  void save(StateWriter &writer) const { writer.write("round-off", watch_.save()); }
  void load(const StateReader &reader) { watch_.load(reader.read("round-off")); }

private:
  struct Limits {
    /// Steps in succession that may be lost: where loads begin, and nodes lie on a tool but for their last
    /// bit, forces are small, and grow soon.
    static constexpr unsigned int max_lost_steps = 3;
    /// What is left beside the round-off of springs, as solve_newton() has it.
    static constexpr double by_much = 10.;
    /// Part of the round-off of bodies below which they have no other forces.
    static constexpr double unloaded = 0.1;
  };

  const ImplicitProblem &problem_;
  RoundOffWatch watch_;
  unsigned int n_lost_ = 0; ///< of the last accepted steps, those that are lost in round-off
};

} // namespace billet

#endif
