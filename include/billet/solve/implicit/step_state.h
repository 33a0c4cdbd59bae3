// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_STEP_STATE_H
#define BILLET_SOLVE_IMPLICIT_STEP_STATE_H

#include "billet/discretization/discretization.h"

namespace billet {

/// Displacements and forces of the bodies at one time, on owned dofs. Forces have the sign of the
/// residual.
struct ForceState {
  explicit ForceState(const Discretization &discretization)
      : displacements(discretization.make_owned_vector()), supports(displacements), contact(displacements),
        internal(displacements) {}

  Vector displacements;
  Vector supports; ///< sum of all forces before constraints: the reactions of supports
  Vector contact;  ///< −F_c
  Vector internal; ///< F_int
};

/// Step that is tried: its start, which changes in commits only, and the trial state of the
/// iterations.
struct StepState {
  explicit StepState(const Discretization &discretization)
      : start(discretization), trial(discretization), ghosted(discretization.make_ghosted_vector()),
        last_increment(discretization.make_owned_vector()) {}

  ForceState start, trial;
  Vector ghosted;        ///< displacements of the trial state, of relevant dofs
  Vector last_increment; ///< displacements of the last accepted step
  double time = 0.;      ///< end of the step
  double duration = 0.;  ///< of the step; 0 during its first guess
};

/// Reference values of residuals [force].
struct ForceScales {
  struct Limits {
    /// Lower limit of the reference value after forces vanish, as part of their largest one.
    static constexpr double lasting = 1e-3;
  };

  double force = 0.;            ///< of the last residual
  double lasting = 0.;          ///< lower limit by earlier forces
  double round_off = 0.;        ///< by round-off of displacements
  double spring_round_off = 0.; ///< by round-off of positions in penalties
  bool contact_bears = false;   ///< whether there was contact at the last residual
};

} // namespace billet

#endif
