// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/run_output.h"

#include "billet/diagnostic_kinds.h"
#include "billet/fail_together.h"
#include "billet/output/console_log.h"
#include "billet/run/output_folder.h"

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <unistd.h>

namespace billet {

namespace {

/// Whether the console is a terminal. Open MPI's mpirun gives its ranks a terminal of its own,
/// wherever its output goes.
bool console_is_terminal() {
  if (isatty(STDOUT_FILENO) == 0)
    return false;
  if (std::getenv("OMPI_COMM_WORLD_SIZE") == nullptr)
    return true;
  std::error_code error;
  const auto target =
      std::filesystem::read_symlink("/proc/" + std::to_string(getppid()) + "/fd/1", error).string();
  return target.rfind("/dev/pts/", 0) == 0 || target.rfind("/dev/tty", 0) == 0;
}

/// Returns the interval between checks for signals [s]; 0 for implicit runs, whose steps are long.
double seconds_between_checks(const parameters::Scene &parameters) {
  return parameters.scheme().has_matrix ? 0. : 0.1;
}

} // namespace

RunOutput::RunOutput(const Scene &scene, const MPI_Comm communicator, Diagnostics &diagnostics,
                     Resumption *resumption, const RunOptions &options)
    : scene_(scene), options_(options), communicator_(communicator),
      is_first_(dealii::Utilities::MPI::this_mpi_process(communicator) == 0),
      writer_(scene, communicator, scene.parameters().output.folder.value),
      snapshots_(scene.parameters(), writer_),
      progress_(scene, stream_of_steps(), is_first_ ? std::cout : silence_,
                &stream_of_steps() == &std::cout && console_is_terminal()),
      diagnostics_(diagnostics), checkpoints_(scene.parameters().output, communicator),
      signals_(communicator, seconds_between_checks(scene.parameters())) {
  const std::string &folder = scene.parameters().output.folder.value;
  const bool continues = resumption != nullptr && resumption->is_from(folder);
  HistoryFile::Mark mark;
  if (resumption != nullptr)
    resumption->in("output", [&] {
      const StateReader &state = resumption->state();
      mark = {state.read_text("columns"), to_count(state.number("bytes"), std::uintmax_t{1} << 50U)};
      checkpoints_.load(state, resumption->report().time, continues);
      snapshots_.load(state);
      if (continues && state.read_text("format") == format())
        writer_.load(state);
      if (continues && state.has("diagnostics"))
        diagnostics_.load(state.read_text("diagnostics"));
    });
  diagnostics_.set_print([this](const Severity severity, const std::string &text) {
    progress_.show_diagnostic(severity, text);
  });
  fail_together(communicator, [&] {
    if (is_first_) {
      write_scene(scene.parameters());
      diagnostics_.open(folder + "/diagnostics.jsonl", continues);
      history_ = continues ? std::make_unique<HistoryFile>(scene, folder, mark, resumption->report().time)
                           : std::make_unique<HistoryFile>(scene, folder);
    }
  });
}

std::ostream &RunOutput::stream_of_steps() {
  if (options_.is_quiet && options_.log != nullptr)
    return options_.log->file();
  if (options_.steps != nullptr)
    return *options_.steps;
  return is_first_ ? std::cout : silence_;
}

void RunOutput::write_row(const std::function<void(HistoryFile &)> &write) {
  fail_together(communicator_, [&] {
    if (is_first_)
      write(*history_);
  });
}

void RunOutput::write_estimate(const ErrorReport &report) {
  errors_ = report;
  fail_together(communicator_, [&] {
    if (is_first_)
      report.write(scene_.parameters().output.folder.value);
  });
}

ExitCode RunOutput::finish(const std::vector<BodyMesh> &bodies) {
  std::string folder = scene_.parameters().output.folder.value;
  if (options_.judge) {
    const Verdict verdict = options_.judge(bodies, errors_);
    report(verdict.messages);
    if (!verdict.folder.empty())
      folder = verdict.folder;
  }
  ExitCode code = ExitCode::success;
  // Scenes with old names run as they did before the names changed.
  const std::size_t n_warnings =
      diagnostics_.count(Severity::warning) - diagnostics_.count(diagnostic::old_name);
  if (scene_.parameters().warnings_are_errors && n_warnings > 0)
    code = ExitCode::warnings;
  else if (diagnostics_.has(diagnostic::target_error_missed) ||
           diagnostics_.has(diagnostic::mesh_target_missed))
    code = ExitCode::target_missed;
  progress_.finish(diagnostics_.repetitions(), diagnostics_.count_in_words(), writer_.file_to_open(folder));
  return code;
}

bool RunOutput::write_checkpoint(const double time, const std::function<void(StateWriter &)> &save) {
  const HistoryFile::Mark mark = is_first_ ? history_->mark() : HistoryFile::Mark();
  const std::string failure = checkpoints_.write(time, [&](StateWriter &state) {
    save(state);
    state.in("output", [&] {
      state.write_text("columns", mark.columns);
      state.write("bytes", {static_cast<double>(mark.n_bytes)});
      state.write_text("format", format());
      state.write_text("diagnostics", diagnostics_.save());
      checkpoints_.save(state);
      snapshots_.save(state);
      writer_.save(state);
    });
  });
  if (!failure.empty())
    diagnostics_.report(Diagnostic(diagnostic::checkpoint_failed,
                                   "The program cannot write a checkpoint: " + failure +
                                       (checkpoints_.last().empty() ? ""
                                                                    : ". The last complete one, " +
                                                                          checkpoints_.last() + ", remains"))
                            .time(time));
  return failure.empty();
}

ExitCode RunOutput::stop(const unsigned int n_steps, const double time, const bool has_checkpoint) {
  std::ostringstream message;
  message << scene_.parameters().file_name << ": " << signals_.name() << " stops the run at time " << time
          << " after " << n_steps << " steps";
  const std::string what = message.str();
  if (!has_checkpoint)
    throw SolutionFailure(
        what + ", and the program cannot write a checkpoint" +
        (checkpoints_.last().empty() ? "" : "; the last complete one is " + checkpoints_.last()));
  // Also on a quiet console.
  diagnostics_.set_print(
      [this](Severity, const std::string &text) { progress_.show_diagnostic(Severity::warning, text); });
  report(Diagnostic(diagnostic::run_stopped, what)
             .advice(options_.judge
                         ? "Begin again: a run with 'Target error of = everything' cannot be resumed"
                         : "Resume by: billet --restart " + checkpoints_.last() + " " + options_.changes +
                               scene_.parameters().file_name));
  return ExitCode::stopped;
}

std::string RunOutput::format() const {
  switch (scene_.parameters().output.format) {
  case parameters::Output::Format::vtu:
    return "vtu";
  case parameters::Output::Format::hdf5:
    return "hdf5";
  case parameters::Output::Format::none:
    break;
  }
  return "none";
}

} // namespace billet
