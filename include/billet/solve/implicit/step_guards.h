// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_STEP_GUARDS_H
#define BILLET_SOLVE_IMPLICIT_STEP_GUARDS_H

#include "billet/solve/implicit/path_guard.h"
#include "billet/solve/implicit/resultant_guard.h"
#include "billet/solve/implicit/round_off_guard.h"
#include "billet/solve/start_gap_watch.h"

namespace billet {

/// Guards of implicit steps: each notices one kind of state that is in balance, and wrong.
class StepGuards {
public:
  explicit StepGuards(ImplicitProblem &problem)
      : paths(problem), round_off(problem), resultants(problem), start_gaps(problem.parts().scene()),
        problem_(problem) {}

  /// Accepts the step to t, whose trial state is still there. Returns messages. Collective.
  DiagnosticList commit(double t, const NewtonReport &report);
  /// Returns messages at the end of the run.
  DiagnosticList finish() const;

  void save(StateWriter &writer) const;
  void load(StateReader &reader);

  PathGuard paths;           ///< nodes that pass through tools, and motions that steps do not see
  RoundOffGuard round_off;   ///< forces that are lost in round-off
  ResultantGuard resultants; ///< bodies whose supports and contacts are out of balance
  StartGapWatch start_gaps;  ///< gaps at the start that change while bodies slide

private:
  const ImplicitProblem &problem_;
};

} // namespace billet

#endif
