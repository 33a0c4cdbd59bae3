// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_RUN_OUTPUT_H
#define BILLET_RUN_RUN_OUTPUT_H

#include "billet/diagnostics.h"
#include "billet/errors.h"
#include "billet/output/error_report.h"
#include "billet/output/history_file.h"
#include "billet/output/progress.h"
#include "billet/run/resumption.h"
#include "billet/run/run_options.h"
#include "billet/run/snapshots.h"

#include <functional>
#include <memory>
#include <sstream>
#include <string>

namespace billet {

/// Files and console of a run: copy of the scene, history, fields, messages and checkpoints. Also
/// handles the signals that request a checkpoint or the end.
class RunOutput {
public:
  /// Makes the folder, or continues the files in it. `resumption`: null if the run begins at
  /// time 0. Collective.
  RunOutput(const Scene &scene, MPI_Comm communicator, Diagnostics &diagnostics, Resumption *resumption,
            const RunOptions &options = {});
  ~RunOutput() { diagnostics_.set_print({}); }
  RunOutput(const RunOutput &) = delete;
  RunOutput &operator=(const RunOutput &) = delete;

  Progress &progress() { return progress_; }
  Snapshots &snapshots() { return snapshots_; }
  /// Reports a message, or a list of them.
  template <class Messages> void report(const Messages &messages) { diagnostics_.report(messages); }
  bool has(const DiagnosticKind &kind) const { return diagnostics_.has(kind); }
  /// Adds a row to the history: `write` gets the file on the first rank. Collective.
  void write_row(const std::function<void(HistoryFile &)> &write);
  /// Writes error_estimate.csv, and keeps the report for the judge of the run. Collective.
  void write_estimate(const ErrorReport &report);

  const Checkpoints &checkpoints() const { return checkpoints_; }
  Signals &signals() { return signals_; }
  /// Writes a checkpoint with the state from `save`. Returns whether that succeeded; a full disk
  /// does not end the run.
  bool write_checkpoint(double time, const std::function<void(StateWriter &)> &save);

  /// Ends a run that has reached its end time. Collective.
  ExitCode finish(const std::vector<BodyMesh> &bodies);
  /// Ends the run as a signal requests. Throws SolutionFailure if there is no checkpoint.
  ExitCode stop(unsigned int n_steps, double time, bool has_checkpoint);

private:
  /// Returns the stream for lines of steps.
  std::ostream &stream_of_steps();
  /// Returns the name of the field output format.
  std::string format() const;

  const Scene &scene_;
  RunOptions options_;
  MPI_Comm communicator_;
  bool is_first_;
  std::ostringstream silence_; ///< console of the other ranks
  FieldWriter writer_;
  Snapshots snapshots_;
  Progress progress_;
  Diagnostics &diagnostics_;
  Checkpoints checkpoints_;
  Signals signals_;
  std::unique_ptr<HistoryFile> history_; ///< on the first rank
  ErrorReport errors_;                   ///< of the run, at its end
};

} // namespace billet

#endif
