// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_FACET_PENETRATIONS_H
#define BILLET_SOLVE_FACET_PENETRATIONS_H

#include "billet/diagnostics.h"
#include "billet/scene/scene.h"
#include "billet/solve/solution.h"

namespace billet {

/// Returns a warning for each pair whose tool penetrates facets between their nodes by more than a
/// tenth of the facets' present length.
DiagnosticList check_facet_penetrations(const Scene &scene, const Solution &solution);

} // namespace billet

#endif
