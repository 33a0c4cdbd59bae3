// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_CHECK_H
#define BILLET_RUN_CHECK_H

#include "billet/discretization/discretization.h"

#include <iosfwd>

namespace billet {

/// Refuses what a run would refuse before its first step, by the same code on the same mesh: throws
/// InputError. Else describes to `stream`, on the first rank, what will be modelled, and what a run would
/// warn of, as text or as one JSON object. Of a restart the checkpoint alone is checked, and the meshes.
/// Collective.
void check_simulation(const parameters::Scene &parameters, MPI_Comm communicator, std::ostream &stream,
                      bool as_json);

/// Returns what is doubtful about the undeformed meshes. Collective.
DiagnosticList check_meshes(const Scene &scene, const Discretization &discretization);

} // namespace billet

#endif
