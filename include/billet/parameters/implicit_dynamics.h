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
  double error_tolerance;        ///< of a step, part of the displacement; 0: none
  double reference_displacement; ///< 0: the largest so far
  double largest_drift;          ///< of energies, part of the largest; 0: the run does not end for it

  static void declare(dealii::ParameterHandler &prm);
  /// `steps_are_fixed`: an error tolerance has no use.
  void parse(Reader &reader, bool steps_are_fixed);
};

} // namespace billet::parameters

#endif
