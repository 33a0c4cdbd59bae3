// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/trial.h"

#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <new>
#include <unistd.h>

namespace billet {

namespace {

constexpr int code_of_return = 0, code_of_memory = 9;

/// Returns the size of this process's address space [bytes].
rlim_t size_of_process() {
  std::ifstream statm("/proc/self/statm");
  rlim_t n_pages = 0;
  statm >> n_pages;
  return n_pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
}

void limit(const decltype(RLIMIT_CPU) resource, const rlim_t value) {
  rlimit limits{};
  getrlimit(resource, &limits);
  limits.rlim_cur = std::min(value, limits.rlim_max);
  setrlimit(resource, &limits);
}

[[noreturn]] void run_in_copy(const TrialLimits &limits, const std::function<void()> &action) {
  // A crash is the default action here, whatever handlers MPI or a debugger's library may have set.
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU})
    std::signal(signal, SIG_DFL);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.seconds);
  limit(RLIMIT_AS, size_of_process() + (static_cast<rlim_t>(limits.megabytes) << 20U));
  try {
    action();
  } catch (const std::bad_alloc &) {
    _exit(code_of_memory);
  } catch (...) { // counts as a return
  }
  _exit(code_of_return);
}

} // namespace

TrialEnd try_in_copy(const TrialLimits &limits, const std::function<void()> &action) {
  const pid_t copy = fork();
  if (copy == 0)
    run_in_copy(limits, action);
  if (copy < 0)
    return TrialEnd::returned;
  int status = 0;
  while (waitpid(copy, &status, 0) < 0 && errno == EINTR)
    continue;
  if (!WIFSIGNALED(status))
    return WEXITSTATUS(status) == code_of_memory ? TrialEnd::out_of_memory : TrialEnd::returned;
  // The system ends a process with SIGKILL where memory is short.
  if (WTERMSIG(status) == SIGKILL)
    return TrialEnd::out_of_memory;
  return WTERMSIG(status) == SIGXCPU ? TrialEnd::out_of_time : TrialEnd::crashed;
}

} // namespace billet
