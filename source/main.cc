// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/errors.h"
#include "billet/simulation.h"
#include "billet/version.h"

#include <deal.II/base/mpi.h>

#include <iostream>
#include <string>
#include <vector>

namespace {

using billet::ExitCode;

const char help[] =
    R"(Usage: mpirun -n N billet SCENE.prm      run a scene on N processes
       billet --restart FILE SCENE.prm  go on from a checkpoint
       billet --check SCENE.prm...      read and check scenes, say what will be modelled, run nothing
       billet --print-parameters        every parameter with default, range, unit and meaning
       billet --version | --help

Exit codes: 0 success; 2 bad input (nothing was written); 3 the solution failed (what was computed is
in the output folder); 4 internal error; 5 stopped by SIGTERM, SIGINT or SIGUSR1 after a checkpoint.
)";

enum class Task { run, check, print_parameters, version, help };

struct CommandLine {
  Task task = Task::help;
  std::vector<std::string> scenes;
  std::string restart_file;
};

[[noreturn]] void refuse(const std::string &argument) {
  throw billet::InputError("command line: found '" + argument + "', allowed is what follows.\n" + help);
}

CommandLine read_command_line(const std::vector<std::string> &arguments) {
  CommandLine command;
  for (auto next = arguments.begin(); next != arguments.end(); ++next) {
    const std::string &argument = *next;
    if (argument == "--help" || argument == "-h")
      return {Task::help, {}, {}};
    if (argument == "--version")
      return {Task::version, {}, {}};
    if (argument == "--print-parameters")
      return {Task::print_parameters, {}, {}};
    if (argument == "--check")
      command.task = Task::check;
    else if (argument == "--restart") {
      if (++next == arguments.end() || next->empty())
        throw billet::InputError(std::string("command line: --restart names no checkpoint.\n") + help);
      command.restart_file = *next;
    } else if (argument.empty() || argument.front() == '-')
      refuse(argument);
    else
      command.scenes.push_back(argument);
  }
  if (command.scenes.empty())
    throw billet::InputError(std::string("command line: no scene file is named.\n") + help);
  if (command.task != Task::check) {
    command.task = Task::run;
    if (command.scenes.size() > 1)
      refuse(command.scenes[1]);
  }
  return command;
}

billet::parameters::Scene read_scene(const std::string &file, const std::string &restart_file) {
  billet::parameters::Scene parameters;
  billet::fail_together(MPI_COMM_WORLD,
                        [&] { parameters = billet::parameters::Scene::read(file, restart_file); });
  return parameters;
}

void say(const std::exception &error, const bool is_first) {
  if (is_first)
    std::cerr << "billet: " << error.what() << std::endl;
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
    if (is_first)
      billet::parameters::print_all_parameters(std::cout);
    break;
  case Task::check:
    for (const auto &file : command.scenes)
      try {
        billet::check_simulation(read_scene(file, command.restart_file), MPI_COMM_WORLD, std::cout);
      } catch (const billet::InputError &error) { // of one scene; the others are checked all the same
        say(error, is_first);
        code = ExitCode::bad_input;
      }
    break;
  case Task::run:
    code = billet::run_simulation(read_scene(command.scenes.front(), command.restart_file), MPI_COMM_WORLD);
    break;
  }
  return code;
}

} // namespace

int main(int argc, char *argv[]) {
  // The program's name alone: PETSc, where deal.II has it, would take --check for an option of its own and
  // complain. One thread a rank: more would only start idle workers.
  int n_for_libraries = 1;
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(n_for_libraries, argv, 1);
  const bool is_first = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  ExitCode code = ExitCode::success;
  try {
    code = perform(read_command_line(std::vector<std::string>(argv + 1, argv + argc)), is_first);
  } catch (const billet::InputError &error) { // the same on all ranks, as is the next
    say(error, is_first);
    code = ExitCode::bad_input;
  } catch (const billet::SolutionFailure &error) {
    say(error, is_first);
    code = ExitCode::failed_solution;
  } catch (const std::exception &error) {
    // Other ranks may be waiting for this one: end them all.
    std::cerr << "billet: internal error: " << error.what() << std::endl;
    MPI_Abort(MPI_COMM_WORLD, static_cast<int>(ExitCode::internal_error));
  }
  return static_cast<int>(code);
}
