// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_SIMULATION_H
#define BILLET_RUN_SIMULATION_H

#include "billet/errors.h"
#include "billet/parameters/scene.h"
#include "billet/run/run_options.h"

#include <mpi.h>

namespace billet {

/// Runs a scene on its mesh as given, from start to end, or from a checkpoint. Throws InputError
/// before anything is written, SolutionFailure after all results are on disk. Returns the exit
/// code: success, warnings, target_missed, or stopped by a signal. A run that would resume at its
/// own end reports that, and is a success. Collective.
ExitCode run_simulation(const parameters::Scene &parameters, MPI_Comm communicator,
                        const RunOptions &options = {});

} // namespace billet

#endif
