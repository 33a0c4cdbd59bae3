// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SIMULATION_H
#define BILLET_SIMULATION_H

#include "billet/errors.h"
#include "billet/parameters/scene.h"

#include <mpi.h>

#include <iosfwd>

namespace billet {

/// Runs a scene from start to end, or from a checkpoint. Collective. Throws InputError before anything is
/// written, SolutionFailure after everything that was computed is on disk. Returns success or, where a signal
/// has ended the run, stopped.
ExitCode run_simulation(const parameters::Scene &parameters, MPI_Comm communicator);

/// Refuses what a run would refuse before its first step, by the same code on the same mesh: throws
/// InputError. Else describes to `stream`, on the first rank, what will be modelled, and what a run would
/// warn of, as text or as one JSON object. Of a restart the checkpoint alone is checked, and the meshes.
/// Collective.
void check_simulation(const parameters::Scene &parameters, MPI_Comm communicator, std::ostream &stream,
                      bool as_json);

/// Throws InputError if the scene's output folder is not there and cannot be made, or cannot be written to.
void check_output_folder(const parameters::Scene &parameters);

} // namespace billet

#endif
