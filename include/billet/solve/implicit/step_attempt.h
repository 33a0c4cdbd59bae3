// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_STEP_ATTEMPT_H
#define BILLET_SOLVE_IMPLICIT_STEP_ATTEMPT_H

#include "billet/solve/implicit/augmentation.h"
#include "billet/solve/implicit/penalty_continuation.h"
#include "billet/solve/implicit/step_guards.h"
#include "billet/solve/implicit/step_rules.h"

#include <vector>

namespace billet {

/// One attempt of a step: first guess, Newton's method, augmentation, tools that stop, and checks
/// of the converged state. It commits nothing.
class StepAttempt {
public:
  /// Components that an attempt uses.
  struct Parts {
    ImplicitProblem &problem;
    EquilibriumSolver &solver;
    PenetrationMeasurement &measurement;
    Augmentation &augmentation;
    PenaltyContinuation &continuation;
    StepGuards &guards;
    StepRules &rules;
  };
  explicit StepAttempt(const Parts &parts) : p_(parts) {}

  /// Path of Newton's method to the end of the step: direct, or by continuation from the lower
  /// penalties of PenaltyContinuation::Start.
  enum class Way { direct, by_enough_penalties, by_low_penalties };
  /// Tries the step to `t`. `previous_step`: see ImplicitSolution::step(). Collective.
  NewtonReport make(double t, double previous_step, Way way = Way::direct);
  /// Returns the tools that have reached their stop force in a converged step.
  const std::vector<std::size_t> &stopping() const { return stopping_; }

private:
  /// Unknowns of the iterations.
  struct Unknowns {
    Vector displacements;
    std::vector<double> offsets;
  };
  void begin(double t);
  /// Does the same as make(), except that it leaves failures of the iterations without other
  /// reasons.
  NewtonReport solve(double t, double previous_step, Way way);
  /// Makes the trial state the first guess. Returns false, with the reason in the report, if no
  /// guess is admissible. `linear_step`: its linear solution; its force is 0 if there was none.
  bool find_guess(double t, double previous_step, NewtonIteration &linear_step, NewtonReport &report);
  /// Moves a tool that has gone too far back to where it exerts its stop force.
  void stop_tools(double t, Unknowns &x, NewtonReport &report);
  /// Iterates further if the state leaves forces of supports or contact pairs out of balance. Keeps
  /// the state if that fails.
  void balance(Unknowns &x, NewtonReport &report);
  /// Evaluates the accepted state, and measures its penetration on request.
  void evaluate(Unknowns &x, NewtonReport &report);
  /// Returns a failure if the converged state is not acceptable.
  std::optional<StepFailure> judge(double t, NewtonReport &report);

  Parts p_;
  std::vector<std::size_t> stopping_;
};

} // namespace billet

#endif
