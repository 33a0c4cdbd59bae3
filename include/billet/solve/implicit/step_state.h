// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_STEP_STATE_H
#define BILLET_SOLVE_IMPLICIT_STEP_STATE_H

#include "billet/discretization/discretization.h"

namespace billet {

/// Displacements and forces of the bodies at one time, of owned dofs. Forces have the sign of the residual.
struct ForceState {
  explicit ForceState(const Discretization &discretization)
      : displacements(discretization.make_owned_vector()), supports(displacements), contact(displacements),
        internal(displacements) {}

  Vector displacements;
  Vector supports; ///< sum of all forces before constraints: what the supports exert
  Vector contact;  ///< −F_c
  Vector internal; ///< F_int
};

/// A step that is tried: its start, which changes in commits only, and the trial state of the iterations.
struct StepState {
  explicit StepState(const Discretization &discretization)
      : start(discretization), trial(discretization), ghosted(discretization.make_ghosted_vector()),
        last_increment(discretization.make_owned_vector()) {}

  ForceState start, trial;
  Vector ghosted;        ///< displacements of the trial state, of relevant dofs
  Vector last_increment; ///< displacements of the last accepted step
  double time = 0.;      ///< end of the step
  double duration = 0.;  ///< of the step; 0 while its first guess is made
};

/// What residuals are small against [force].
struct ForceScales {
  double force = 0.;            ///< of the last residual
  double lasting = 0.;          ///< measure that forces leave when they go
  double round_off = 0.;        ///< that the last bits of displacements make
  double spring_round_off = 0.; ///< that the last bits of positions make of penalties
  bool contact_bears = false;   ///< at the last residual
};

} // namespace billet

#endif
