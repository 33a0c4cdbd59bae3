// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/serve.h"

#include "billet/errors.h"
#include "billet/run/launch.h"

#include <csignal>
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

extern "C" { // which this header of glibc 2.36 leaves to others
#include <sys/pidfd.h>
}

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace billet {

namespace {

constexpr int cannot_start = 126; // as of shells that cannot start a command
constexpr std::size_t longest_request = std::size_t{1} << 20;
constexpr int patience = 30000; // milliseconds for which a server waits for someone

struct RunRequest {
  std::vector<std::string> words; ///< folder, variables, an empty word, arguments
  std::array<int, 2> outputs{{-1, -1}};
};

struct RunEnd {
  int status;
  double seconds;
};

/// Returns false at the end of the requests.
bool receive(RunRequest &request) {
  std::vector<char> text(longest_request);
  iovec part{text.data(), text.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(2 * sizeof(int))> control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = recvmsg(STDIN_FILENO, &message, MSG_CMSG_CLOEXEC);
  const cmsghdr *const attached = CMSG_FIRSTHDR(&message);
  if (size <= 0 || attached == nullptr || attached->cmsg_type != SCM_RIGHTS)
    return false;
  std::memcpy(request.outputs.data(), CMSG_DATA(attached), sizeof request.outputs);
  for (const char *word = text.data(); word < text.data() + size; word += request.words.back().size() + 1)
    request.words.emplace_back(word);
  return true;
}

/// Gives this process the folder, the environment and the outputs of a run. Returns its arguments.
std::vector<std::string> become_run(const RunRequest &request) {
  const int nothing = open("/dev/null", O_RDONLY);
  if (chdir(request.words.front().c_str()) != 0 || dup2(nothing, STDIN_FILENO) < 0 ||
      dup2(request.outputs[0], STDOUT_FILENO) < 0 || dup2(request.outputs[1], STDERR_FILENO) < 0)
    _exit(cannot_start);
  auto word = request.words.begin() + 1;
  for (; word != request.words.end() && !word->empty(); ++word) {
    const auto equals = std::min(word->find('='), word->size());
    setenv(word->substr(0, equals).c_str(), word->c_str() + std::min(equals + 1, word->size()), 1);
  }
  return {std::min(word + 1, request.words.end()), request.words.end()};
}

template <typename T> bool answer(const T &value) {
  return send(STDIN_FILENO, &value, sizeof value, MSG_NOSIGNAL) > 0;
}

double seconds(const timeval &time) { return time.tv_sec + 1e-6 * time.tv_usec; }

/// Waits for the end of a run, which comes at once if nobody is there to ask for it.
void wait_for(const pid_t child, RunEnd &end) {
  const int process = pidfd_open(child, 0);
  std::array<pollfd, 2> either{{{process, POLLIN, 0}, {STDIN_FILENO, POLLRDHUP, 0}}};
  while (process >= 0 && poll(either.data(), either.size(), -1) < 0 && errno == EINTR) {
  }
  if (process >= 0 && either[0].revents == 0)
    kill(-child, SIGKILL);
  close(process);
  rusage used{};
  while (wait4(child, &end.status, 0, &used) < 0 && errno == EINTR) {
  }
  end.seconds = seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// Whether a user's own process is at the other end: anyone may find the socket.
bool is_own(const int connection) {
  ucred other{};
  socklen_t size = sizeof other;
  return getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &other, &size) == 0 && other.uid == geteuid();
}

/// Removes children that have ended. Returns whether others go on.
bool has_children() {
  pid_t ended = 0;
  do
    ended = waitpid(-1, nullptr, WNOHANG);
  while (ended > 0);
  return ended == 0;
}

/// Gives each of those who connect a child of this process, whose standard input their socket is.
/// Returns whether this process is such a child.
bool serve_each() {
  pollfd someone{STDIN_FILENO, POLLIN, 0};
  while (poll(&someone, 1, patience) > 0 || has_children()) {
    if (someone.revents == 0)
      continue;
    const int connection = accept(STDIN_FILENO, nullptr, nullptr);
    if (connection < 0) { // too many files are open, or who came has gone
      poll(nullptr, 0, 100);
      continue;
    }
    if (is_own(connection) && fork_child(SIGKILL) == 0) {
      dup2(connection, STDIN_FILENO);
      close(connection);
      return true;
    }
    close(connection);
    has_children();
  }
  return false;
}

bool listens() {
  int value = 0;
  socklen_t size = sizeof value;
  return getsockopt(STDIN_FILENO, SOL_SOCKET, SO_ACCEPTCONN, &value, &size) == 0 && value != 0;
}

} // namespace

std::optional<std::vector<std::string>> serve_runs() {
  if (listens() && !serve_each())
    return {};
  if (!answer(0))
    throw InputError(
        "command line: '--serve' finds no socket as standard input; allowed is what programs that "
        "start many runs give it, such as billet-trade");
  for (bool goes_on = true; goes_on;) {
    RunRequest request;
    if (!receive(request))
      break;
    const pid_t child = fork_child(SIGKILL);
    if (child == 0)
      return become_run(request);
    for (const int output : request.outputs)
      close(output);
    RunEnd end{cannot_start << 8, 0.};
    goes_on = answer(child);
    if (child > 0)
      wait_for(child, end);
    goes_on = goes_on && answer(end);
  }
  return {};
}

} // namespace billet
