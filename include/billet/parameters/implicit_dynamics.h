// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_IMPLICIT_DYNAMICS_H
#define BILLET_PARAMETERS_IMPLICIT_DYNAMICS_H

#include "billet/integration/time_integrator.h"
#include "billet/parameters/reader.h"

namespace billet::parameters {

/// Subsection Implicit dynamics.
struct ImplicitDynamics {
  enum class Mass { consistent, lumped };

  TimeIntegrator integrator;
  Mass mass;
  double error_tolerance;        ///< of a step, relative to the displacement; 0: none
  double reference_displacement; ///< 0: maximum so far
  /// Maximum drift relative to the maximum energy; 0: the run never ends for it.
  double max_drift;

  static void declare(dealii::ParameterHandler &prm);
  /// Reads the subsection. `steps_are_fixed`: an error tolerance has no effect.
  void parse(Reader &reader, bool steps_are_fixed);
};

} // namespace billet::parameters

#endif
