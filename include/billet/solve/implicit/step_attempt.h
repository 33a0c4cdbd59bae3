// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_STEP_ATTEMPT_H
#define BILLET_SOLVE_IMPLICIT_STEP_ATTEMPT_H

#include "billet/solve/implicit/augmentation.h"
#include "billet/solve/implicit/penalty_continuation.h"
#include "billet/solve/implicit/round_off_guard.h"
#include "billet/solve/implicit/step_rules.h"

#include <vector>

namespace billet {

/// One attempt of a step: first guess, Newton's method, augmentation, tools that stop, and the judgement of
/// the state that has converged. Commits nothing.
class StepAttempt {
public:
  /// What an attempt is made with.
  struct Parts {
    ImplicitProblem &problem;
    EquilibriumSolver &solver;
    PenetrationMeasurement &measurement;
    Augmentation &augmentation;
    PenaltyContinuation &continuation;
    PathGuard &paths;
    const RoundOffGuard &round_off;
    StepRules &rules;
  };
  explicit StepAttempt(const Parts &parts) : p_(parts) {}

  /// How Newton's method comes to the end of the step: straight, or led by softer penalties.
  enum class Way { direct, by_softer_penalties };
  /// Tries the step to `t`. `previous_step`: see ImplicitSolution::step(). Collective.
  NewtonReport make(double t, double previous_step, Way way = Way::direct);
  /// Tools that have reached their stop force in a step that has converged.
  const std::vector<std::size_t> &stopping() const { return stopping_; }

private:
  /// Unknowns of the iterations.
  struct Unknowns {
    Vector displacements;
    std::vector<double> offsets;
  };
  void begin(double t);
  /// Makes the trial state the first guess. False, with the reason, where there is none that is admissible.
  /// `linear_step`: what it took; of no force if it took no solution.
  bool find_guess(double t, double previous_step, NewtonIteration &linear_step, NewtonReport &report);
  /// A tool that has gone too far is drawn back to where it presses with its stop force.
  void stop_tools(double t, Unknowns &x, NewtonReport &report);
  /// Evaluates the accepted state, and measures its penetration if that is asked for.
  void evaluate(Unknowns &x, NewtonReport &report);
  /// Fails the step where its state is not to be accepted.
  void judge(double t, NewtonReport &report);

  Parts p_;
  std::vector<std::size_t> stopping_;
};

} // namespace billet

#endif
