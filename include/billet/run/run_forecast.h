// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_RUN_FORECAST_H
#define BILLET_RUN_RUN_FORECAST_H

#include "billet/run/scene_report.h"
#include "billet/solve/explicit/explicit_dynamics.h"
#include "billet/solve/implicit/implicit_solution.h"

namespace billet {

/// Returns what an explicit run will be like. Computes the forces at the start, and the steps where
/// the pairs meet, as far as `report` knows; `problem` cannot continue then. Without a stable step
/// if the start fails, as the run will. Collective.
RunReport forecast_run(const Scene &scene, ExplicitDynamics &problem, const SceneReport &report);

/// Returns what an implicit run will be like. Collective.
RunReport forecast_run(const Scene &scene, const ImplicitSolution &problem);

} // namespace billet

#endif
