// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_INITIAL_MOTION_H
#define BILLET_SOLVE_IMPLICIT_INITIAL_MOTION_H

#include "billet/solve/implicit/implicit_problem.h"

namespace billet {

/// Accelerations at the start of a motion, and after jumps of forces: M a = −F.
class InitialMotion {
public:
  InitialMotion(ImplicitProblem &problem, ImplicitMotion &motion) : problem_(problem), motion_(motion) {}

  /// Starts the run at time 0: forces, accelerations and energies. Throws InputError or
  /// SolutionFailure. Collective.
  void start();
  /// Computes the accelerations by the forces at the start of the step. Throws SolutionFailure.
  /// Collective.
  void accelerate();
  /// Reads the motion from a checkpoint, or begins it from another method's state. Collective.
  void load(StateReader &reader, RestartReport &report);

private:
  /// Relative tolerance of the accelerations.
  static constexpr double tolerance = 1e-10;

  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
  ImplicitMotion &motion_;
};

} // namespace billet

#endif
