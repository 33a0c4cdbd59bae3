// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_RUN_FORECAST_H
#define BILLET_RUN_RUN_FORECAST_H

#include "billet/run/scene_report.h"
#include "billet/solve/explicit/explicit_dynamics.h"
#include "billet/solve/implicit/implicit_solution.h"

namespace billet {

/// Returns what an explicit run will be like. Computes the forces at the start, so that `problem` is then in
/// its first step. Without a stable step if that fails, as the run will. Collective.
RunReport forecast_run(const Scene &scene, ExplicitDynamics &problem);

/// Returns what an implicit run will be like. Collective.
RunReport forecast_run(const Scene &scene, const ImplicitSolution &problem);

} // namespace billet

#endif
