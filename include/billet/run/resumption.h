// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_RESUMPTION_H
#define BILLET_RUN_RESUMPTION_H

#include "billet/discretization/discretization.h"
#include "billet/output/checkpoint.h"
#include "billet/scene/scene.h"
#include "billet/solve/restart.h"

#include <functional>
#include <memory>

namespace billet {

/// Thrown on all ranks if the checkpoint is from the end of the scene that resumes from it.
struct AlreadyComplete {
  Diagnostic diagnostic;
};

/// Start of a run from a checkpoint, in place of time 0.
struct Resumption {
  CheckpointReader reader;
  RestartReport report;

  /// Opens the checkpoint that the scene names; returns null if it names none. Throws InputError if the file
  /// is no valid checkpoint. Collective.
  static std::unique_ptr<Resumption> open(const parameters::Scene &parameters, MPI_Comm communicator);

  /// Whether the checkpoint is in this folder; then the run continues the files there.
  bool is_from(const std::string &folder) const;
  /// Checks the scene against the checkpoint and calls `load`, which reads the solution and returns the
  /// report. Throws InputError if the scene does not fit, AlreadyComplete if nothing remains to be computed.
  void load(const Scene &scene, const Discretization &discretization,
            const std::function<RestartReport()> &load);
  /// Returns a message about time and changes of the scene. It includes unbalanced forces above this relative
  /// tolerance.
  Diagnostic describe(double force_tolerance) const;
};

} // namespace billet

#endif
