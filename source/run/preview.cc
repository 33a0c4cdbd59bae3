// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/preview.h"

#include "billet/errors.h"
#include "billet/fail_together.h"
#include "billet/output/field_writer.h"
#include "billet/output/paraview_script.h"
#include "billet/output/preview_grids.h"
#include "billet/output/snapshot_grids.h"
#include "billet/run/check.h"
#include "billet/run/output_folder.h"
#include "billet/run/run.h"
#include "billet/scene/plausibility.h"
#include "billet/solve/explicit/explicit_dynamics.h"
#include "billet/solve/implicit/implicit_solution.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <ostream>
#include <sstream>

namespace billet {

namespace {

namespace fs = std::filesystem;

/// Whether a program is found as a shell would find it.
bool is_installed(const std::string &program) {
  const char *path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((folder + "/" + program).c_str(), X_OK) == 0)
      return true;
  return false;
}

/// Returns the environment without the variables by which MPI would take a program for one of our
/// ranks.
std::vector<std::string> foreign_environment() {
  std::vector<std::string> variables;
  for (char **variable = environ; *variable != nullptr; ++variable) {
    const std::string text = *variable;
    bool is_of_mpi = false;
    for (const std::string start : {"OMPI_", "PMIX_", "PMI_", "PRTE_", "ORTE_", "HYDRA_", "MPI_"})
      is_of_mpi = is_of_mpi || text.rfind(start, 0) == 0;
    if (!is_of_mpi)
      variables.push_back(text);
  }
  return variables;
}

/// Returns pointers for exec.
std::vector<char *> pointers_to(std::vector<std::string> &words) {
  std::vector<char *> pointers;
  for (std::string &word : words)
    pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// Runs a program whose output goes into a file. Returns its exit code; -1 if it has none.
int run_with_log(std::vector<std::string> words, const std::string &log) {
  std::vector<std::string> variables = foreign_environment();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  constexpr mode_t readable = 0644;
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   readable);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const bool has_started = posix_spawnp(&child, words.front().c_str(), &actions, nullptr,
                                        pointers_to(words).data(), pointers_to(variables).data()) == 0;
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  return has_started && waitpid(child, &status, 0) == child && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Returns the last line of a file that is not empty.
std::string last_line(const std::string &name) {
  std::ifstream file(name);
  std::string last;
  for (std::string line; std::getline(file, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos)
      last = line;
  return last;
}

/// Returns the scene's parameters with its own folder and format for the preview.
parameters::Scene parameters_of_preview(parameters::Scene parameters) {
  parameters.output.folder.value += "/preview";
  parameters.output.format = parameters::Output::Format::vtu;
  return parameters;
}

/// Writes the solution at its start. Collective.
void write_start(const Scene &scene, const Solution &solution) {
  const MPI_Comm communicator = solution.discretization().communicator();
  std::vector<Grid> grids = make_snapshot_grids(scene, solution);
  for (Grid &grid : make_preview_grids(scene, solution.discretization()))
    grids.push_back(std::move(grid));
  FieldWriter(scene, communicator, scene.parameters().output.folder.value).write_preview(solution, grids);
}

} // namespace

Picture draw_picture(const std::string &script, const std::string &file) {
  if (!is_installed("pvbatch"))
    return {"", "ParaView's 'pvbatch' is not installed"};
  const char *display = std::getenv("DISPLAY");
  const std::string seconds = "300"; // a display may not answer
  constexpr int out_of_time = 124;   // the exit code of 'timeout'
  std::vector<std::string> words = {"timeout", seconds};
  if (display == nullptr || *display == '\0') {
    if (!is_installed("xvfb-run"))
      return {"", "without a display, 'pvbatch' needs 'xvfb-run', which is not installed"};
    // Displays that start at the same time look for free numbers from different ones on.
    words.insert(words.end(), {"xvfb-run", "-a", "-n", std::to_string(100 + getpid() % 900)});
  }
  words.insert(words.end(), {"pvbatch", script, file});
  std::error_code error;
  fs::remove(file, error);
  const std::string log = file + ".log";
  constexpr unsigned int n_attempts = 2; // under load a display may start too late
  int code = 0;
  for (unsigned int i = 0; i < n_attempts; ++i) {
    code = run_with_log(words, log);
    if (code == 0 && fs::exists(file, error)) {
      fs::remove(log, error);
      return {file, ""};
    }
  }
  const std::string last = last_line(log);
  return {"", "'pvbatch " + script + " " + file + "' fails twice" +
                  (code == out_of_time ? ", at last after " + seconds + " s without an end" : "") +
                  (last.empty() ? "" : ", and says at last '" + last + "' (all of it in '" + log + "')")};
}

void preview_simulation(const parameters::Scene &of_run, const MPI_Comm communicator, std::ostream &stream) {
  const parameters::Scene parameters = parameters_of_preview(of_run);
  const bool is_first = dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
  fail_together(communicator, [&] { check_output_folder(parameters, EarlierResults::replaced); });
  const std::unique_ptr<const Scene> built = build_scene(parameters, communicator);
  const Scene &scene = *built;
  const Discretization discretization(scene, communicator);
  DiagnosticList messages = scene.parameters().warnings;
  append(messages, check_plausibility(scene, discretization.dof_handler().get_triangulation(), communicator));
  append(messages, check_meshes(scene, discretization));
  const auto prepare = [&] {
    fail_together(communicator, [&] {
      if (is_first)
        prepare_output_folder(parameters, EarlierResults::replaced);
    });
  };
  if (!parameters.scheme().has_matrix) {
    ExplicitDynamics problem(scene, discretization);
    append(messages, problem.initial_diagnostics());
    prepare();
    try {
      problem.prepare_step(parameters.time_stepping.end_time);
    } catch (const SolutionFailure &) {
      // The forces at the start fail: the scene can still be looked at.
    }
    problem.update_state();
    write_start(scene, problem);
  } else {
    const ImplicitSolution problem(scene, discretization);
    append(messages, problem.initial_diagnostics());
    prepare();
    write_start(scene, problem);
  }
  if (!is_first)
    return;
  for (const auto &message : messages)
    stream << message.text() << "\n";
  const std::string &folder = parameters.output.folder.value;
  const Picture picture = draw_picture(folder + "/" + paraview_script_name, folder + "/scene.png");
  if (parameters.output.verbosity == parameters::Output::Verbosity::quiet)
    return;
  stream << parameters.file_name << ": open in ParaView: " << folder
         << "/scene.pvd (or paraview --script=" << folder << "/" << paraview_script_name << ")\n"
         << (picture.file.empty() ? "No picture: " + picture.reason : "Picture: " + picture.file) << "\n";
}

} // namespace billet
