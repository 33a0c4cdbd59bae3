// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs billet in children of a process that has its libraries already. Loading and binding them takes most of
// the time of a small scene. fork_server.py asks for runs on the socket that is standard input: a message has
// the folder and the arguments of a run, each with a final zero byte, and the descriptors of both outputs.
// Answers are the number of the process, and what waitpid() says of its end.
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

int billet_main(int argc, char *argv[]); // main() of source/main.cc

namespace {

constexpr int failed = 126; // as of shells that cannot start a command

struct Request {
  std::vector<std::string> words; ///< folder, program, arguments
  std::array<int, 2> outputs{{-1, -1}};
};

/// Returns false at the end of the requests.
bool receive(Request &request) {
  std::vector<char> text(std::size_t{1} << 20);
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

/// Becomes the run. Does not return.
[[noreturn]] void perform(Request &request) {
  setpgid(0, 0);
  unsetenv("LD_BIND_NOW"); // it is the server's
  const int nothing = open("/dev/null", O_RDONLY);
  if (chdir(request.words.front().c_str()) != 0 || dup2(nothing, STDIN_FILENO) < 0 ||
      dup2(request.outputs[0], STDOUT_FILENO) < 0 || dup2(request.outputs[1], STDERR_FILENO) < 0)
    _exit(failed);
  std::vector<char *> arguments;
  for (std::size_t i = 1; i < request.words.size(); ++i)
    arguments.push_back(request.words[i].data());
  arguments.push_back(nullptr);
  std::exit(billet_main(static_cast<int>(arguments.size() - 1), arguments.data()));
}

bool answer(const int number) { return send(STDIN_FILENO, &number, sizeof number, MSG_NOSIGNAL) > 0; }

} // namespace

int main() {
  for (;;) {
    Request request;
    if (!receive(request))
      return 0;
    const pid_t child = fork();
    if (child == 0)
      perform(request);
    for (const int output : request.outputs)
      close(output);
    int status = failed << 8;
    if (!answer(child))
      return 1;
    while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (!answer(status))
      return 1;
  }
}
