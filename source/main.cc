// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/parameters/scene_update.h"
#include "billet/run/check.h"
#include "billet/run/simulation.h"
#include "billet/version.h"

#include <deal.II/base/mpi.h>

#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

using billet::ExitCode;

const char help[] =
    R"(Usage: mpirun -n N billet SCENE.prm      run a scene on N processes
       billet --restart FILE SCENE.prm  resume from a checkpoint
       billet --check SCENE.prm...      read and check scenes, say what will be modelled, run nothing
       billet --update-scene OLD [NEW]  write a scene with today's names of parameters to NEW, or print it
       billet --print-parameters        every parameter with default, range, unit and meaning
       billet --print-diagnostics       every message by its key, with meaning and remedy
       billet --version | --help

With --json, --check prints one JSON object per scene and line, --print-parameters a JSON Schema of
scenes, --print-diagnostics a JSON array.

Exit codes: 0 success; 2 bad input (nothing was written); 3 the solution failed (what was computed is
in the output folder); 4 internal error; 5 stopped by SIGTERM, SIGINT or SIGUSR1 after a checkpoint;
6 completed with warnings, and the scene says 'Warnings = errors'; 7 completed, and the estimated error
exceeds the 'Target error'.
)";

enum class Task { run, check, update_scene, print_parameters, print_diagnostics, version, help };

struct CommandLine {
  Task task = Task::help;
  std::vector<std::string> scenes;
  std::string restart_file;
  bool json = false;
};

[[noreturn]] void refuse(const std::string &argument) {
  throw billet::InputError("command line: '" + argument +
                           "' is not allowed here; allowed is the following.\n" + help);
}

CommandLine read_command_line(const std::vector<std::string> &arguments) {
  CommandLine command;
  for (auto next = arguments.begin(); next != arguments.end(); ++next) {
    const std::string &argument = *next;
    if (argument == "--help" || argument == "-h")
      return {Task::help, {}, {}};
    if (argument == "--version")
      return {Task::version, {}, {}};
    if (argument == "--json")
      command.json = true;
    else if (argument == "--print-parameters")
      command.task = Task::print_parameters;
    else if (argument == "--print-diagnostics")
      command.task = Task::print_diagnostics;
    else if (argument == "--check")
      command.task = Task::check;
    else if (argument == "--update-scene")
      command.task = Task::update_scene;
    else if (argument == "--restart") {
      if (++next == arguments.end() || next->empty())
        throw billet::InputError(
            std::string("command line: '--restart' names no checkpoint; allowed is the following.\n") + help);
      command.restart_file = *next;
    } else if (argument.empty() || argument.front() == '-')
      refuse(argument);
    else
      command.scenes.push_back(argument);
  }
  if (command.task == Task::print_parameters || command.task == Task::print_diagnostics)
    return command;
  if (command.scenes.empty())
    throw billet::InputError(
        std::string("command line: it names no scene file; allowed is the following.\n") + help);
  if (command.task == Task::check)
    return command;
  if (command.json)
    refuse("--json");
  if (command.task != Task::update_scene)
    command.task = Task::run;
  const std::size_t max_files = command.task == Task::run ? 1 : 2;
  if (command.scenes.size() > max_files)
    refuse(command.scenes[max_files]);
  return command;
}

billet::parameters::Scene read_scene(const std::string &file, const std::string &restart_file) {
  billet::parameters::Scene parameters;
  billet::fail_together(MPI_COMM_WORLD,
                        [&] { parameters = billet::parameters::Scene::read(file, restart_file); });
  return parameters;
}

void print_errors(const billet::DiagnosticList &errors, const bool is_first) {
  if (is_first)
    for (const auto &error : errors)
      std::cerr << error.text() << std::endl;
}

/// Prints the JSON object of `--check --json` for a refused scene.
void print_refusal(const std::string &file, const billet::InputError &error, const bool is_first) {
  if (is_first)
    std::cout << billet::describe_refusal_as_json(file, error.diagnostics()) << "\n";
}

/// Writes the scene of the first file with current names to the second file, or prints it. Reports the
/// changes.
void update_scene(const std::vector<std::string> &files) {
  const billet::SceneUpdate update = billet::update_scene(files.front());
  const bool has_target = files.size() > 1;
  if (has_target) {
    std::ofstream stream(files.back(), std::ios::binary);
    stream << update.text;
    stream.close();
    if (!stream)
      throw billet::InputError("command line: '" + files.back() +
                               "' cannot be written; allowed is the name of a writable file");
  } else
    std::cout << update.text;
  std::ostream &report = has_target ? std::cout : std::cerr;
  for (const auto &change : update.changes)
    report << change << "\n";
  for (const auto &change : update.left)
    report << change << "; this included file does not change, so update it too\n";
  if (update.changes.empty() && update.left.empty())
    report << files.front() << ": all names are current\n";
}

void print_diagnostic_kinds(std::ostream &stream) {
  stream
      << "# Messages\n\n"
         "Each message of a run has a key. `billet --print-diagnostics` prints this page; the messages of a "
         "run stand in\n`diagnostics.jsonl` in its output folder.\n\n"
         "| key | severity | meaning | remedy |\n|---|---|---|---|\n";
  for (const billet::DiagnosticKind *kind : billet::all_diagnostic_kinds())
    stream << "| `" << kind->key << "` | " << billet::to_string(kind->severity) << " | " << kind->meaning
           << " | " << kind->remedy << " |\n";
}

ExitCode perform(const CommandLine &command, const bool is_first) {
  ExitCode code = ExitCode::success;
  switch (command.task) {
  case Task::help:
    if (is_first)
      std::cout << help;
    break;
  case Task::version:
    if (is_first)
      std::cout << "billet " << billet::version << " (" << billet::git_revision << "), deal.II "
                << billet::dealii_version << "\n";
    break;
  case Task::print_parameters:
    if (is_first && command.json)
      billet::parameters::print_schema(std::cout);
    else if (is_first)
      billet::parameters::print_all_parameters(std::cout);
    break;
  case Task::print_diagnostics:
    if (is_first && command.json)
      std::cout << billet::describe_diagnostic_kinds_as_json() << "\n";
    else if (is_first)
      print_diagnostic_kinds(std::cout);
    break;
  case Task::check:
    for (const auto &file : command.scenes)
      try {
        billet::check_simulation(read_scene(file, command.restart_file), MPI_COMM_WORLD, std::cout,
                                 command.json);
      } catch (const billet::InputError &error) { // the other scenes are still checked
        if (command.json)
          print_refusal(file, error, is_first);
        else
          print_errors(error.diagnostics(), is_first);
        code = ExitCode::bad_input;
      }
    break;
  case Task::update_scene:
    billet::fail_together(MPI_COMM_WORLD, [&] {
      if (is_first)
        update_scene(command.scenes);
    });
    break;
  case Task::run:
    code = billet::run_simulation(read_scene(command.scenes.front(), command.restart_file), MPI_COMM_WORLD);
    break;
  }
  return code;
}

} // namespace

int main(int argc, char *argv[]) {
  // Only the program's name is passed on: PETSc, if deal.II has it, would interpret --check as its own
  // option. One thread for each rank: more would be idle.
  int n_for_libraries = 1;
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(n_for_libraries, argv, 1);
  const bool is_first = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  ExitCode code = ExitCode::success;
  try {
    code = perform(read_command_line(std::vector<std::string>(argv + 1, argv + argc)), is_first);
  } catch (const billet::InputError &error) { // thrown on all ranks, as is SolutionFailure
    print_errors(error.diagnostics(), is_first);
    code = ExitCode::bad_input;
  } catch (const billet::SolutionFailure &error) {
    print_errors({error.diagnostic()}, is_first);
    code = ExitCode::failed_solution;
  } catch (const std::exception &error) {
    // Other ranks may be waiting for this one: abort all of them.
    std::cerr << billet::Diagnostic(billet::diagnostic::internal_error, error.what()).text() << std::endl;
    MPI_Abort(MPI_COMM_WORLD, static_cast<int>(ExitCode::internal_error));
  }
  return static_cast<int>(code);
}
