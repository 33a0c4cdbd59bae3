// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_TARGET_MESH_H
#define BILLET_RUN_TARGET_MESH_H

#include "billet/run/simulation.h"

namespace billet {

/// Runs a scene as run_simulation() does. With 'Target error of = everything', runs it on levels of
/// the given meshes from coarse to fine. Each level is in a folder 'mesh_level_N' in the output
/// folder. The levels end when the error of the mesh is within what other errors leave of the
/// target. The finest level or the end of the memory also ends them.
///
/// The results of the last level then are in the output folder itself, with mesh_levels.csv. Throws
/// and returns as run_simulation().
ExitCode run_to_target(const parameters::Scene &parameters, MPI_Comm communicator,
                       const RunOptions &options = {});

} // namespace billet

#endif
