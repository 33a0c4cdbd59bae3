// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_PAIR_REPORT_H
#define BILLET_RUN_PAIR_REPORT_H

#include "billet/discretization/discretization.h"
#include "billet/run/scene_report.h"

namespace billet {

/// Returns the gaps of all pairs at time 0, and when they close while bodies move as rigid ones.
/// The motions are those that tools and supports prescribe and, in dynamic scenes, the initial
/// velocities. `bodies`: their reports. Between bodies, the nodes of each surface are measured from
/// the facets of the other. Collective.
std::vector<PairReport> report_pairs(const Scene &scene, const Discretization &discretization,
                                     const std::vector<BodyReport> &bodies);

/// Returns a warning about each body whose initial velocity brings it to no other body and to no
/// tool until the end. Bodies whose motion forces may change get none. `bodies`, `pairs`: their
/// reports.
DiagnosticList check_flights(const Scene &scene, const std::vector<BodyReport> &bodies,
                             const std::vector<PairReport> &pairs);

} // namespace billet

#endif
