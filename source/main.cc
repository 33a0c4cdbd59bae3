// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/fail_together.h"
#include "billet/nearest_name.h"
#include "billet/output/console_log.h"
#include "billet/parameters/scene_update.h"
#include "billet/run/all_errors.h"
#include "billet/run/certify.h"
#include "billet/run/check.h"
#include "billet/run/launch.h"
#include "billet/run/new_scene.h"
#include "billet/run/preview.h"
#include "billet/run/serve.h"
#include "billet/run/target_mesh.h"
#include "billet/run/type_lists.h"
#include "billet/shipped.h"
#include "billet/version.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <spawn.h>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

namespace {

using billet::ExitCode;

const char help[] =
    R"(Usage: billet SCENE.prm...               run scenes on one process, one after the other
       billet --ranks N SCENE.prm       run it on N processes; on several machines:
                                        mpirun -n N billet SCENE.prm
       billet --restart FILE SCENE.prm  resume from a checkpoint
       billet --check SCENE.prm...      read and check scenes, say what will be modelled, run nothing
       billet --preview SCENE.prm...    check scenes, write them undeformed for ParaView and as a
                                        picture, to the folder 'preview' in the output folder
       billet --certify FILE.prm...     try out the laws of a scene's bodies, or a file of material
                                        parameters
       billet --update-scene OLD [NEW]  write a scene with today's names of parameters to NEW, or
                                        print it
       billet --new KIND [FILE]         write a scene to begin with to KIND.prm or FILE: forging,
                                        drawing, ...
       billet --list [LIST [NAME...]]   what scenes can name: primitives, materials, surfaces, loads, ...
       billet --print-parameters        every parameter with default, range, unit and meaning
       billet --print-diagnostics       every message by its key, with meaning and remedy
       billet --manual                  open the manual, or say where it is
       billet --version | --help

Options of runs, checks and previews:
       --set PATH=VALUE   override a parameter of the scene, such as --set "Time stepping/End time=2";
                          an empty VALUE takes the parameter's line away
       --output FOLDER    write results to FOLDER; without it, and without 'Folder' in the scene, they
                          go to a folder with the name of the scene
       --force            replace results of an earlier run; without it they are moved to FOLDER.1,
                          FOLDER.2...
       --quiet            print warnings and errors only
       --markdown         --certify prints its page in Markdown
       --json             --check prints one JSON object per scene and line, --print-parameters a JSON
                          Schema of scenes, --list and --print-diagnostics a JSON array

Exit codes:
       0   success
       2   bad input; nothing was written
       3   the solution failed, and what was computed is in the output folder; or a law fails its
           certification
       4   internal error
       5   stopped by SIGTERM, SIGINT or SIGUSR1 after a checkpoint
       6   completed with warnings, and the scene says 'Warnings = errors'
       7   completed, and the estimated error exceeds the 'Target error'

)";

/// Returns where one of these is, or its name where the program stands alone.
std::string place_of(const std::vector<std::string> &places) {
  const std::string found = billet::find_shipped(places);
  return found.empty() ? places.back() + " in the sources" : found;
}

/// Returns the manual: the site if it is there, else its source.
std::string find_manual() {
  return place_of({"share/doc/billet/html/index.html", "doc/html/index.html", "share/doc/billet/manual.md",
                   "doc/manual.md"});
}

void print_help(std::ostream &stream) {
  stream << help << "Shipped scenes:  "
         << place_of({"share/billet/prm/billet_upsetting.prm", "prm/billet_upsetting.prm"})
         << " and others beside it\nManual:          " << find_manual()
         << "\nbillet-trade:    measures accuracy against cost of a scene's parameters; see 'billet-trade "
            "--help'\nbillet-fit:      fits materials to measured curves; see 'billet-fit --help'\n";
}

/// Prints where the manual is. In a graphical session the desktop's program for such files shows
/// it.
void open_manual() {
  std::string manual = find_manual();
  std::cout << "The manual is " << manual << std::endl;
  const auto is_set = [](const char *name) {
    const char *const value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY"))
    return;
  std::string program = "xdg-open";
  std::array<char *, 3> arguments = {program.data(), manual.data(), nullptr};
  pid_t viewer = 0;
  if (posix_spawnp(&viewer, program.c_str(), nullptr, nullptr, arguments.data(), environ) != 0)
    std::cout << "xdg-open, which would show it, is not installed" << std::endl;
}

enum class Task {
  run,
  check,
  preview,
  certify,
  update_scene,
  new_scene,
  list,
  print_parameters,
  print_diagnostics,
  manual,
  version,
  help
};

struct CommandLine {
  Task task = Task::help;
  std::vector<std::string> scenes;
  std::string restart_file;
  bool json = false;
  bool markdown = false;
  std::vector<billet::SceneFile::Setting> settings;
  bool replaces_results = false;
  bool is_quiet = false;
  std::string option_of_runs; ///< the last option that runs and checks alone have
};

/// Options, the tasks among them, for advice on misspelt ones.
const std::vector<std::string> options = {
    "--certify",          "--check",    "--force", "--help",    "--json",    "--list",
    "--manual",           "--markdown", "--new",   "--output",  "--preview", "--print-diagnostics",
    "--print-parameters", "--quiet",    "--ranks", "--restart", "--set",     "--update-scene",
    "--version"};

/// Returns the help as the end of a message, which gets a full stop.
std::string allowed_arguments() {
  const std::string text = help;
  return "allowed is the following.\n" + text.substr(0, text.find_last_not_of(".\n") + 1);
}

[[noreturn]] void refuse(const std::string &argument) {
  const std::string advice = billet::did_you_mean(argument, options);
  throw billet::InputError(
      "command line: '" + argument + "' is not allowed here" +
      (advice.empty() ? "; " + allowed_arguments() : advice + " 'billet --help' shows what is allowed"));
}

/// Returns the argument of an option. Throws InputError if there is none.
std::string argument_of(const std::string &option, const std::vector<std::string> &arguments,
                        std::size_t &next, const std::string &what) {
  if (++next == arguments.size() || arguments[next].empty())
    throw billet::InputError("command line: '" + option + "' names no " + what + "; " + allowed_arguments());
  return arguments[next];
}

/// Reads an option of runs and checks. Returns false if it is none.
bool read_option_of_runs(const std::string &option, const std::vector<std::string> &arguments,
                         std::size_t &next, CommandLine &command) {
  if (option == "--restart")
    command.restart_file = argument_of(option, arguments, next, "checkpoint");
  else if (option == "--set") {
    const std::string setting = argument_of(option, arguments, next, "parameter");
    const auto equals = setting.find('=');
    if (equals == std::string::npos)
      throw billet::InputError("command line: '--set' is followed by '" + setting +
                               "'; allowed is a path and a value, such as 'Time stepping/End time=2'");
    command.settings.push_back({setting.substr(0, equals), setting.substr(equals + 1), "--set " + setting});
  } else if (option == "--output") {
    const std::string folder = argument_of(option, arguments, next, "folder");
    command.settings.push_back({"Output/Folder", folder, "--output " + folder});
  } else if (option == "--quiet")
    command.is_quiet = true;
  else if (option == "--force")
    command.replaces_results = true;
  else
    return false;
  command.option_of_runs = option;
  return true;
}

/// Refuses arguments of '--new' other than the kind of scene and the name of a file.
void check_new(const CommandLine &command) {
  if (command.json)
    refuse("--json");
  if (command.scenes.empty()) {
    std::string kinds;
    for (const billet::SceneTemplate &kind : billet::scene_templates())
      kinds += (kinds.empty() ? "" : ", ") + kind.name;
    throw billet::InputError("command line: '--new' names no kind of scene; allowed is one of: " + kinds);
  }
  if (command.scenes.size() > 2)
    refuse(command.scenes[2]);
}

/// Options that end the reading of the command line.
const std::vector<std::pair<std::string, Task>> information_options = {
    {"--help", Task::help}, {"-h", Task::help}, {"--manual", Task::manual}, {"--version", Task::version}};

CommandLine read_command_line(const std::vector<std::string> &arguments) {
  CommandLine command;
  const std::vector<std::pair<std::string, Task>> tasks = {{"--print-parameters", Task::print_parameters},
                                                           {"--print-diagnostics", Task::print_diagnostics},
                                                           {"--check", Task::check},
                                                           {"--certify", Task::certify},
                                                           {"--list", Task::list},
                                                           {"--preview", Task::preview},
                                                           {"--new", Task::new_scene},
                                                           {"--update-scene", Task::update_scene}};
  for (std::size_t next = 0; next < arguments.size(); ++next) {
    const std::string argument = arguments[next];
    const auto task = std::find_if(tasks.begin(), tasks.end(),
                                   [&](const auto &candidate) { return candidate.first == argument; });
    for (const auto &[name, information] : information_options)
      if (argument == name) {
        command.task = information;
        return command;
      }
    if (argument == "--json")
      command.json = true;
    else if (argument == "--markdown")
      command.markdown = true;
    else if (task != tasks.end())
      command.task = task->second;
    else if (argument.empty() ||
             (argument.front() == '-' && !read_option_of_runs(argument, arguments, next, command)))
      refuse(argument);
    else if (argument.front() != '-')
      command.scenes.push_back(argument);
  }
  if (command.markdown && command.task != Task::certify)
    refuse("--markdown");
  if (command.task == Task::print_parameters || command.task == Task::print_diagnostics ||
      command.task == Task::list)
    return command;
  if (command.task == Task::new_scene) {
    check_new(command);
    return command;
  }
  if (command.scenes.empty())
    throw billet::InputError("command line: it names no scene file; " + allowed_arguments());
  if (command.task == Task::check)
    return command;
  if (command.json)
    refuse("--json");
  if (command.task == Task::preview || command.task == Task::certify) {
    if (!command.restart_file.empty()) // a resumed run begins deformed
      refuse("--restart");
    if (command.is_quiet)
      command.settings.push_back({"Output/Verbosity", "quiet", "--quiet"});
    return command;
  }
  if (command.task != Task::update_scene)
    command.task = Task::run;
  else if (!command.option_of_runs.empty())
    refuse(command.option_of_runs);
  if (command.task == Task::update_scene && command.scenes.size() > 2)
    refuse(command.scenes[2]);
  return command;
}

void print_errors(const billet::DiagnosticList &errors, const bool is_first) {
  if (is_first)
    for (const auto &error : errors)
      std::cerr << error.text() << std::endl;
}

/// Lets children of this process run what is asked for if the only argument is --serve, see
/// billet::serve_runs(). The arguments of a child are then those of its run.
std::optional<int> serve(std::vector<std::string> &arguments) {
  if (arguments != std::vector<std::string>{"--serve"})
    return {};
  try {
    const auto run = billet::serve_runs();
    if (!run)
      return static_cast<int>(ExitCode::success);
    arguments = *run;
  } catch (const billet::InputError &error) {
    print_errors(error.diagnostics(), true);
    return static_cast<int>(ExitCode::bad_input);
  }
  return {};
}

/// Lets a child of this process run each scene if the arguments name several, see
/// billet::run_each(). The arguments of a child are then those of its scene.
std::optional<int> run_each(std::vector<std::string> &arguments) {
  if (billet::is_launched())
    return {};
  std::vector<std::string> ranks, others = arguments;
  if (const auto option = std::find(others.begin(), others.end(), "--ranks"); option != others.end()) {
    if (option + 1 == others.end()) // launch() refuses it
      return {};
    ranks.assign(option, option + 2);
    others.erase(option, option + 2);
  }
  try {
    const CommandLine command = read_command_line(others);
    if (command.task != Task::run || command.scenes.size() < 2)
      return {};
    for (const std::string name : {"--output", "--restart"})
      if (std::find(others.begin(), others.end(), name) != others.end())
        throw billet::InputError("command line: '" + name + "' is for one scene, and " +
                                 std::to_string(command.scenes.size()) +
                                 " are named; allowed is one scene with it, or several without");
    std::size_t scene = 0;
    if (const auto code = billet::run_each(command.scenes, scene))
      return code;
    arguments = ranks;
    for (const std::string &argument : others)
      if (std::find(command.scenes.begin(), command.scenes.end(), argument) == command.scenes.end())
        arguments.push_back(argument);
    arguments.push_back(command.scenes[scene]);
  } catch (const billet::InputError &error) {
    print_errors(error.diagnostics(), true);
    return static_cast<int>(ExitCode::bad_input);
  }
  return {};
}

/// Returns a text as one word of a shell.
std::string quote(const std::string &text) {
  if (text.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,%") ==
      std::string::npos)
    return text;
  std::string quoted = "'";
  for (const char c : text)
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// Returns the options that changed the scene, as a shell reads them, each with a blank behind.
std::string changes_of(const CommandLine &command) {
  std::string options;
  for (const auto &setting : command.settings) {
    const std::string::size_type value = setting.where.find(' ');
    options += setting.where.substr(0, value) +
               (value == std::string::npos ? "" : " " + quote(setting.where.substr(value + 1))) + " ";
  }
  return options;
}

billet::parameters::Scene read_scene(const std::string &file, const CommandLine &command) {
  billet::parameters::Scene parameters;
  billet::fail_together(MPI_COMM_WORLD, [&] {
    parameters = billet::parameters::Scene::read(file, command.restart_file, command.settings);
  });
  return parameters;
}

/// Calls `use` with the parameters of a scene. Throws InputError with all errors of the scene, not
/// only with those that show first.
template <class Function>
void use_scene(const std::string &file, const CommandLine &command, const Function &use) {
  try {
    use(read_scene(file, command));
  } catch (const billet::InputError &error) { // on all ranks
    throw billet::InputError(billet::find_all_errors({file, command.restart_file, command.settings},
                                                     error.diagnostics(), MPI_COMM_WORLD));
  }
}

/// Prints the JSON object of `--check --json` for a refused scene.
void print_refusal(const std::string &file, const billet::InputError &error, const bool is_first) {
  if (is_first)
    std::cout << billet::describe_refusal_as_json(file, error.diagnostics()) << "\n";
}

/// Writes the scene of the first file with current names to the second file, or prints it. Reports
/// the changes.
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

/// Writes a scene of the kind of the first name, to a file of the second. Says what to do with it.
void new_scene(const std::vector<std::string> &names) {
  const std::string file = billet::write_new_scene(names.front(), names.size() > 1 ? names[1] : "");
  std::cout << "Wrote " << file << ". Check it:  billet --check " << file << "\nRun it:  billet " << file
            << "\n";
}

/// Certifies the laws of all files. Returns whether they pass.
bool certify(const CommandLine &command) {
  bool have_passed = true;
  for (const auto &file : command.scenes)
    have_passed =
        billet::certify_laws(file, command.settings,
                             command.markdown ? billet::PageFormat::markdown : billet::PageFormat::text,
                             std::cout) &&
        have_passed;
  return have_passed;
}

void print_diagnostic_kinds(std::ostream &stream) {
  stream
      << "# Messages\n\n"
         "Each message of a run has a key. `billet --print-diagnostics` prints this page; the messages of\n"
         "a run stand in `diagnostics.jsonl` in its output folder.\n\n"
         "| key | severity | meaning | remedy |\n|---|---|---|---|\n";
  for (const billet::DiagnosticKind *kind : billet::all_diagnostic_kinds())
    stream << "| `" << kind->key << "` | " << billet::to_string(kind->severity) << " | " << kind->meaning
           << " | " << kind->remedy << " |\n";
}

ExitCode perform(const CommandLine &command, const bool is_first, billet::ConsoleLog *log) {
  ExitCode code = ExitCode::success;
  switch (command.task) {
  case Task::help:
    if (is_first)
      print_help(std::cout);
    break;
  case Task::version:
    if (is_first)
      std::cout << "billet " << billet::version << " (" << billet::git_revision << "), deal.II "
                << billet::dealii_version << "\n";
    break;
  case Task::manual:
    if (is_first)
      open_manual();
    break;
  case Task::list:
    billet::fail_together(MPI_COMM_WORLD, [&] {
      if (is_first)
        billet::print_types(std::cout, command.scenes, command.json);
    });
    break;
  case Task::new_scene:
    billet::fail_together(MPI_COMM_WORLD, [&] {
      if (is_first)
        new_scene(command.scenes);
    });
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
        use_scene(file, command, [&](const billet::parameters::Scene &scene) {
          billet::check_simulation(scene, MPI_COMM_WORLD, std::cout, command.json);
        });
      } catch (const billet::InputError &error) { // the other scenes are still checked
        if (command.json)
          print_refusal(file, error, is_first);
        else
          print_errors(error.diagnostics(), is_first);
        code = ExitCode::bad_input;
      }
    break;
  case Task::preview:
    for (const auto &file : command.scenes)
      try {
        use_scene(file, command, [&](const billet::parameters::Scene &scene) {
          billet::preview_simulation(scene, MPI_COMM_WORLD, std::cout);
        });
      } catch (const billet::InputError &error) { // the other scenes are still shown
        print_errors(error.diagnostics(), is_first);
        code = ExitCode::bad_input;
      }
    break;
  case Task::certify:
    billet::fail_together(MPI_COMM_WORLD, [&] {
      if (is_first && !certify(command))
        code = ExitCode::failed_solution;
    });
    break;
  case Task::update_scene:
    billet::fail_together(MPI_COMM_WORLD, [&] {
      if (is_first)
        update_scene(command.scenes);
    });
    break;
  case Task::run:
    if (command.scenes.size() > 1) // on several ranks at once
      refuse(command.scenes[1]);
    use_scene(command.scenes.front(), command, [&](const billet::parameters::Scene &scene) {
      code = billet::run_to_target(scene, MPI_COMM_WORLD,
                                   {command.replaces_results, log, command.is_quiet, changes_of(command)});
    });
    break;
  }
  return code;
}

} // namespace

int main(int argc, char *argv[]) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  if (const auto code = serve(arguments))
    return *code;
  if (const auto code = run_each(arguments))
    return *code;
  if (const auto code = billet::launch(arguments))
    return *code;
  const billet::ProcessAlone alone;
  // Only the program's name is passed on: PETSc, if deal.II has it, would interpret --check as its
  // own option. One thread for each rank: more would be idle.
  int n_for_libraries = 1;
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(n_for_libraries, argv, 1);
  const bool is_first = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  const auto log = is_first ? std::make_unique<billet::ConsoleLog>() : nullptr;
  ExitCode code = ExitCode::success;
  try {
    code = perform(read_command_line(arguments), is_first, log.get());
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
  return billet::report_exit_code(static_cast<int>(code), is_first);
}
