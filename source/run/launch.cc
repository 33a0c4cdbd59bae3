// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/launch.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace billet {

namespace {

constexpr const char *exit_code_file = "BILLET_EXIT_CODE_FILE"; // in the environment of the ranks
constexpr int max_ranks = 99999;

volatile pid_t mpirun = 0;
volatile pid_t current_run = 0; // of run_each()
volatile std::sig_atomic_t is_to_stop = 0;

/// mpirun passes SIGUSR1 and SIGUSR2 on to its ranks, but kills them on other signals. A second
/// Ctrl-C does that.
void pass_on(const int signal) {
  static volatile std::sig_atomic_t n_stops = 0;
  const bool stops = signal != SIGUSR1 && signal != SIGUSR2;
  if (stops)
    n_stops = n_stops + 1;
  if (mpirun > 0)
    kill(mpirun, !stops ? signal : n_stops == 1 ? SIGUSR1 : SIGTERM);
}

void pass_on_to_run(const int signal) {
  if (signal != SIGUSR2)
    is_to_stop = 1;
  if (current_run > 0)
    kill(current_run, signal);
}

[[noreturn]] void refuse(const std::string &what) { throw InputError("command line: " + what); }

/// Takes "--ranks N" from the arguments. Returns N; empty if it is not there.
std::string take_ranks(std::vector<std::string> &arguments) {
  const auto option = std::find(arguments.begin(), arguments.end(), "--ranks");
  if (option == arguments.end())
    return "";
  const std::string number = option + 1 == arguments.end() ? "" : *(option + 1);
  if (number.empty() || number.size() > 5 || number.find_first_not_of("0123456789") != std::string::npos ||
      std::stoi(number) < 1)
    refuse("'--ranks' is '" + number + "'; allowed is a whole number from 1 to " + std::to_string(max_ranks));
  if (is_launched())
    refuse("'--ranks' is not allowed under mpirun; allowed is one of the two");
  arguments.erase(option, option + 2);
  return number;
}

/// Becomes mpirun. Does not return.
[[noreturn]] void become_mpirun(const std::string &n_ranks, const std::vector<std::string> &arguments) {
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  std::error_code error;
  std::vector<std::string> words = {"mpirun", "-n", n_ranks,
                                    std::filesystem::read_symlink("/proc/self/exe", error).string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char *> pointers;
  for (std::string &word : words)
    pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execvp("mpirun", pointers.data());
  std::cerr << Diagnostic(diagnostic::bad_input, std::string("command line: '--ranks' needs mpirun, which "
                                                             "cannot be started: ") +
                                                     std::strerror(errno))
                   .text()
            << std::endl;
  _exit(static_cast<int>(ExitCode::bad_input));
}

/// Waits for mpirun. Returns its exit code, or that of the ranks.
int wait_for_ranks(const std::string &file) {
  int status = 0;
  while (waitpid(mpirun, &status, 0) < 0 && errno == EINTR) {
  }
  constexpr int by_signal = 128;
  int code = WIFEXITED(status) ? WEXITSTATUS(status) : by_signal + WTERMSIG(status);
  if (code == 0 && !(std::ifstream(file) >> code))
    code = static_cast<int>(ExitCode::internal_error);
  return code;
}

/// Signals wait while it lives.
class SignalsWait {
public:
  SignalsWait() {
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, &others_);
  }
  ~SignalsWait() { sigprocmask(SIG_SETMASK, &others_, nullptr); }
  SignalsWait(const SignalsWait &) = delete;
  SignalsWait &operator=(const SignalsWait &) = delete;

private:
  sigset_t others_{};
};

/// Waits for a run of run_each(). Returns its exit code.
int wait_for_run(const std::string &scene) {
  int status = 0;
  while (waitpid(current_run, &status, 0) < 0 && errno == EINTR) {
  }
  current_run = 0;
  if (WIFEXITED(status))
    return WEXITSTATUS(status);
  if (is_to_stop != 0) // while it started
    return static_cast<int>(ExitCode::stopped);
  const int signal = WTERMSIG(status);
  std::cerr << Diagnostic(diagnostic::internal_error, scene + ": the run was ended by signal " +
                                                          std::to_string(signal) + ", " + strsignal(signal))
                   .text()
            << std::endl;
  return static_cast<int>(ExitCode::internal_error);
}

} // namespace

bool is_launched() {
  const std::array<const char *, 5> variables = {
      {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMIX_NAMESPACE", "PMI_SIZE", "PMI_RANK"}};
  return std::any_of(variables.begin(), variables.end(),
                     [](const char *variable) { return std::getenv(variable) != nullptr; });
}

pid_t fork_child(const int last_signal) {
  const pid_t parent = getpid(), child = fork();
  if (child == 0) {
    setpgid(0, 0); // Ctrl-C reaches the parent alone, which passes it on
    prctl(PR_SET_PDEATHSIG, last_signal);
    if (getppid() != parent)
      _exit(static_cast<int>(ExitCode::internal_error));
  } else if (child > 0)
    setpgid(child, child); // before anyone signals the group
  return child;
}

std::optional<int> run_each(const std::vector<std::string> &scenes, std::size_t &scene) {
  const std::array<int, 4> signals = {{SIGINT, SIGTERM, SIGUSR1, SIGUSR2}};
  int first_code = static_cast<int>(ExitCode::success);
  for (scene = 0; scene < scenes.size() && is_to_stop == 0; ++scene) {
    for (const int signal : signals)
      std::signal(signal, pass_on_to_run);
    std::cout << "Scene " << scene + 1 << " of " << scenes.size() << ": " << scenes[scene] << std::endl;
    {
      const SignalsWait wait;
      if (is_to_stop != 0)
        break;
      current_run = fork_child(SIGKILL);
      if (current_run == 0) {
        for (const int signal : signals)
          std::signal(signal, signal == SIGUSR2 ? SIG_IGN : SIG_DFL); // until there is something to write
        return {};
      }
    }
    const int code =
        current_run > 0 ? wait_for_run(scenes[scene]) : static_cast<int>(ExitCode::internal_error);
    if (first_code == 0)
      first_code = code;
    if (code == static_cast<int>(ExitCode::stopped))
      break;
  }
  return first_code == 0 && scene < scenes.size() ? static_cast<int>(ExitCode::stopped) : first_code;
}

std::optional<int> launch(const std::vector<std::string> &arguments) {
  try {
    std::vector<std::string> others = arguments;
    const std::string n_ranks = take_ranks(others);
    if (n_ranks.empty())
      return {};
    std::string file = std::filesystem::temp_directory_path() / "billet.XXXXXX";
    const int descriptor = mkstemp(file.data());
    if (descriptor < 0)
      refuse("'--ranks' needs a temporary file, and '" + file + "' cannot be made: " + std::strerror(errno));
    close(descriptor);
    setenv(exit_code_file, file.c_str(), 1);
    for (const int signal : {SIGINT, SIGTERM, SIGUSR1, SIGUSR2})
      std::signal(signal, pass_on);
    mpirun = fork_child(SIGTERM);
    if (mpirun == 0)
      become_mpirun(n_ranks, others);
    const int code = mpirun > 0 ? wait_for_ranks(file) : static_cast<int>(ExitCode::internal_error);
    std::remove(file.c_str());
    return code;
  } catch (const InputError &error) {
    std::cerr << error.diagnostic().text() << std::endl;
    return static_cast<int>(ExitCode::bad_input);
  }
}

ProcessAlone::ProcessAlone() {
  if (is_launched())
    return;
  constexpr int keep = 0; // what the user has set
  setenv("OMPI_MCA_pml", "ob1", keep);
  setenv("OMPI_MCA_btl", "self", keep);
  std::error_code none;
  std::string folder = std::filesystem::temp_directory_path(none) / "billet.XXXXXX";
  if (mkdtemp(folder.data()) == nullptr)
    return;
  folder_ = folder;
  setenv("OMPI_MCA_ess_singleton_isolated", "1", keep);
  setenv("OMPI_MCA_orte_tmpdir_base", folder_.c_str(), keep);
}

ProcessAlone::~ProcessAlone() {
  std::error_code none;
  if (!folder_.empty())
    std::filesystem::remove_all(folder_, none);
}

int report_exit_code(const int code, const bool is_first) {
  const char *file = std::getenv(exit_code_file);
  if (file == nullptr)
    return code;
  if (!is_first)
    return 0;
  std::ofstream stream(file);
  stream << code << "\n";
  stream.close();
  return stream ? 0 : code;
}

} // namespace billet
