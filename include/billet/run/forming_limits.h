// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_FORMING_LIMITS_H
#define BILLET_RUN_FORMING_LIMITS_H

#include "billet/solve/solution.h"

namespace billet {

/// Returns a warning for each body whose major strain exceeds the forming limit of its material,
/// with the largest ratio of the two. Collective.
DiagnosticList check_forming_limits(const Scene &scene, const Solution &solution);

} // namespace billet

#endif
