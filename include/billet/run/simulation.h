// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_SIMULATION_H
#define BILLET_RUN_SIMULATION_H

#include "billet/errors.h"
#include "billet/parameters/scene.h"

#include <mpi.h>

#include <iosfwd>
#include <string>

namespace billet {

class ConsoleLog;

/// What the command line says of a run, beside parameters.
struct RunOptions {
  bool replaces_results = false; ///< rather than to move those of an earlier run aside
  ConsoleLog *log = nullptr;     ///< to be opened in the output folder; null: none
  bool is_quiet = false;         ///< the console gets warnings and errors only, the log all
  std::string changes = {};      ///< options that changed the scene, for the command that resumes the run
  std::ostream *steps = nullptr; ///< gets lines of steps if the console is quiet and the log is open already
};

/// Runs a scene on its mesh as given, from start to end, or from a checkpoint. Throws InputError before
/// anything is written, SolutionFailure after all results are on disk. Returns the exit code: success,
/// warnings, target_missed, or stopped by a signal. A run that would resume at its own end reports that, and
/// is a success. Collective.
ExitCode run_simulation(const parameters::Scene &parameters, MPI_Comm communicator,
                        const RunOptions &options = {});

} // namespace billet

#endif
