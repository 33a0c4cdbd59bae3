// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_SERVE_H
#define BILLET_RUN_SERVE_H

#include <optional>
#include <string>
#include <vector>

namespace billet {

/// Performs `billet --serve`: runs the program in children of this process, which has loaded the
/// libraries already. That takes most of the time of a small scene. Requests come from the socket
/// that is standard input (billet_tools/fork_server.py asks for runs so), one after the other:
///
/// - A message of this process, the number 0, says that it serves.
/// - A request is a message of the folder, variables of the environment as NAME=VALUE, an empty
///   word and the arguments of a run, each with a zero byte at its end. It has descriptors of both
///   outputs attached.
/// - The answers are the number of the child (int), and when it has ended what waitpid() says of it
///   (int) and its seconds of the processor (double).
///
/// Who asked and closes the socket, or is killed, ends the run. Where standard input is a socket
/// that listens, as that of many tests, each of those who connect is served so, at the same time,
/// until none has come for half a minute.
///
/// Returns the arguments in a child, which leads a group of processes; nothing in this process, at
/// the end of the requests. To be called before MPI starts. Throws InputError if standard input is
/// no socket.
std::optional<std::vector<std::string>> serve_runs();

} // namespace billet

#endif
