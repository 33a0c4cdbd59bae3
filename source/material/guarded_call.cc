// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/guarded_call.h"

#include <array>
#include <csetjmp>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <unistd.h>
#include <vector>

namespace billet {

namespace {

constexpr std::array<int, 5> crashes = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
constexpr int left_early = -1;
constexpr int exit_code = 3; // of a failed solution

// Signal handlers reach nothing but static data.
sigjmp_buf way_back;
const char *volatile running = nullptr; // name of the running code; null: none runs
std::array<struct sigaction, crashes.size()> former;

void write_error(const char *text) {
  std::size_t length = 0;
  while (text[length] != '\0')
    ++length;
  if (write(STDERR_FILENO, text, length) < 0)
    return; // nobody is left to hear of it
}

void go_back(const int reason) {
  running = nullptr;
  siglongjmp(way_back, reason);
}

void handle(const int signal) {
  if (running != nullptr)
    go_back(signal);
  for (std::size_t i = 0; i < crashes.size(); ++i) // a crash of the program itself
    if (crashes[i] == signal)
      sigaction(signal, &former[i], nullptr);
  raise(signal);
}

void report_exit() {
  if (running == nullptr)
    return;
  write_error("error[solution-failed]: ");
  write_error(const_cast<const char *>(running));
  write_error(" has ended the program, by STOP or by an error of its language's run-time library.\n");
  _exit(exit_code); // not that of STOP, which is success
}

/// Installs the handlers, on a stack of their own: the code may have exhausted the usual one.
bool install() {
  static std::vector<char> memory(std::size_t{64} * 1024);
  stack_t stack = {};
  stack.ss_sp = memory.data();
  stack.ss_size = memory.size();
  sigaltstack(&stack, nullptr);
  struct sigaction action = {};
  action.sa_handler = &handle;
  action.sa_flags = SA_ONSTACK | SA_NODEFER; // after the jump the signal must not stay blocked
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < crashes.size(); ++i)
    sigaction(crashes[i], &action, &former[i]);
  std::atexit(&report_exit);
  return true;
}

} // namespace

std::string CallResult::describe() const {
  if (end == CallEnd::left)
    return "ended the analysis by XIT";
  switch (signal) {
  case 0:
    return "";
  case SIGSEGV:
  case SIGBUS:
    return "crashed by a segmentation fault (an array index out of bounds is the usual cause)";
  case SIGFPE:
    return "crashed by an arithmetic exception, such as an integer division by zero";
  case SIGILL:
    return "crashed by an illegal instruction: it was built for another processor";
  default:
    return "aborted itself";
  }
}

CallResult call_guarded(void (*const function)(void *), void *const data, const char *const name) {
  static const bool is_installed = install();
  static_cast<void>(is_installed);
  const int reason = sigsetjmp(way_back, 0); // 0: saving the mask would cost a system call
  if (reason == 0) {
    running = name;
    function(data);
    running = nullptr;
    return {};
  }
  return reason == left_early ? CallResult{CallEnd::left, 0} : CallResult{CallEnd::crashed, reason};
}

void leave_guarded_call() {
  if (running != nullptr)
    go_back(left_early);
}

} // namespace billet
