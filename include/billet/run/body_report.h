// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_BODY_REPORT_H
#define BILLET_RUN_BODY_REPORT_H

#include "billet/discretization/discretization.h"
#include "billet/run/scene_report.h"

namespace billet {

/// Returns the reports of all bodies. Collective.
std::vector<BodyReport> report_bodies(const Scene &scene, const Discretization &discretization);

/// Returns the scaled Jacobian of an undeformed element; see BodyReport::min_quality.
double scaled_jacobian(const CellIterator &cell);
/// Returns the least edge of an undeformed element [length].
double min_edge(const CellIterator &cell);

} // namespace billet

#endif
