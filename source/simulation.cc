// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/simulation.h"

#include "billet/errors.h"
#include "billet/output/field_writer.h"
#include "billet/output/history_file.h"
#include "billet/output/progress.h"
#include "billet/solve/quasi_static.h"
#include "billet/solve/step_control.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

namespace billet {

namespace {

/// Makes the folder and puts a copy of the scene as it was read into it. First rank only.
void prepare_folder(const parameters::Scene &parameters) {
  const std::filesystem::path folder = parameters.output.folder.value;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::ofstream copy(folder / "scene.prm");
  copy << parameters.text;
  if (error || !copy.flush())
    throw InputError(parameters.output.folder.origin + ": nothing can be written to '" + folder.string() +
                     "'");
}

/// Whether somebody may be watching. Open MPI's mpirun hands its ranks a terminal of its own, whatever its
/// output goes to.
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

/// Writes fields at the start, as often as the scene asks for, and at the end.
class Snapshots {
public:
  Snapshots(const parameters::Scene &parameters, FieldWriter &writer)
      : output_(parameters.output), end_(parameters.time_stepping.end_time), writer_(writer) {}

  void after_step(const unsigned int step, const QuasiStatic &problem) {
    const double time = problem.state().time;
    const bool by_interval =
        output_.interval > 0. && time >= (n_intervals_ + 1) * output_.interval * (1. - 1e-8);
    if (by_interval)
      ++n_intervals_;
    const bool by_steps =
        output_.interval == 0. && output_.every_steps > 0 && step % output_.every_steps == 0;
    if (by_interval || by_steps || time >= end_)
      write(problem);
  }
  void write(const QuasiStatic &problem) {
    if (problem.state().time == last_)
      return;
    writer_.write(problem);
    last_ = problem.state().time;
  }

private:
  const parameters::Output &output_;
  double end_;
  FieldWriter &writer_;
  unsigned int n_intervals_ = 0;
  double last_ = -1.;
};

std::string explain_failure(const parameters::Scene &parameters, const StepReport &report, const double from,
                            const double to) {
  std::ostringstream message;
  message << parameters.file_name << ": the step from time " << from << " to " << to << " failed after "
          << report.step << " accepted steps and " << report.total_cuts << " cuts: " << report.newton.failure
          << "; residual " << report.newton.force << " of the forces, allowed is "
          << parameters.solver.force_tolerance << ". ";
  if (parameters.time_stepping.control == parameters::TimeStepping::Control::fixed)
    message << "Steps are fixed: try a smaller 'Initial step' or 'Step control = automatic'";
  else
    message << "The step cannot be cut below 'Smallest step' = " << parameters.time_stepping.smallest_step
            << ": try a softer penalty, another 'Contact tangent', more 'Most iterations', or look at the "
               "last picture for "
               "an unstable or torn mesh";
  message << ". What was computed until time " << from << " is in '" << parameters.output.folder.value
          << "'.";
  return message.str();
}

} // namespace

void check_output_folder(const parameters::Scene &parameters) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path folder = fs::absolute(parameters.output.folder.value, error);
  while (!fs::exists(folder, error) && folder.has_relative_path())
    folder = folder.parent_path();
  if (!fs::is_directory(folder, error) || access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(parameters.output.folder.origin + ": found '" + parameters.output.folder.value +
                     "', allowed is a folder that can be made and written to; '" + folder.string() + "' is " +
                     (fs::is_directory(folder, error) ? "not writable" : "not a folder"));
  for (const std::string name : {"scene.prm", "history.csv"}) {
    const fs::path file = fs::path(parameters.output.folder.value) / name;
    if (fs::exists(file, error) && (fs::is_directory(file, error) || access(file.c_str(), W_OK) != 0))
      throw InputError(parameters.output.folder.origin + ": found '" + parameters.output.folder.value +
                       "', allowed is a folder that can be made and written to; '" + file.string() +
                       "' cannot be written over");
  }
}

void run_simulation(const parameters::Scene &parameters, MPI_Comm communicator) {
  const bool is_first = dealii::Utilities::MPI::this_mpi_process(communicator) == 0;

  // Set up: everything that can be wrong with the scene shows here, before anything is written.
  fail_together(communicator, [&] { check_output_folder(parameters); });
  const Scene scene(parameters);
  const Discretization discretization(scene, communicator);
  QuasiStatic problem(scene, discretization);
  StepControl control(parameters.time_stepping, parameters.output.interval, scene.stops());

  std::unique_ptr<HistoryFile> history;
  fail_together(communicator, [&] {
    if (is_first) {
      prepare_folder(parameters);
      history = std::make_unique<HistoryFile>(scene, parameters.output.folder.value);
    }
  });
  FieldWriter writer(scene, discretization, parameters.output.folder.value);
  Snapshots snapshots(parameters, writer);
  std::ostringstream silence;
  Progress progress(scene, is_first ? std::cout : silence, is_first && console_is_terminal());
  progress.start(discretization, problem, discretization.dof_handler().n_dofs());
  snapshots.write(problem);

  // Run.
  StepReport report;
  double continued = 0.; // length of the last step, if its increment may be continued
  while (!control.is_finished()) {
    const double from = control.time(), to = control.next_time();
    report.length = to - from;
    report.newton = problem.step(to, continued);
    report.total_iterations += static_cast<unsigned int>(report.newton.iterations.size());
    if (report.newton.converged) {
      control.accept(static_cast<unsigned int>(report.newton.iterations.size()));
      continued = report.length;
      report.step = control.n_steps();
      fail_together(communicator, [&] {
        if (is_first)
          history->write(report, problem.state());
      });
      progress.accept(report, problem.state());
      snapshots.after_step(control.n_steps(), problem);
      continue;
    }
    progress.reject(report, from, to);
    const bool may_go_on = control.reject();
    report.total_cuts = control.n_cuts();
    if (!may_go_on) {
      snapshots.write(problem);
      throw SolutionFailure(explain_failure(parameters, report, from, to));
    }
  }
  progress.finish(writer.file_to_open());
}

} // namespace billet
