// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_LAUNCH_H
#define BILLET_RUN_LAUNCH_H

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace billet {

/// Performs `billet --ranks N ...`. It starts the program on N processes of this machine by mpirun
/// and returns its exit code. It returns nothing if the arguments have no --ranks. The processes
/// end with 0 and leave their exit code in a file, since mpirun adds a message of its own to any
/// other code.
///
/// Ctrl-C and SIGTERM stop the run as SIGUSR1 does, with a checkpoint. To be called before MPI
/// starts.
std::optional<int> launch(const std::vector<std::string> &arguments);

/// Whether mpirun or a batch system started this process as one of its ranks.
bool is_launched();

/// Runs several scenes one after the other, each in a child of this process. The libraries are
/// loaded once: that takes most of the time of a small scene. A child that crashes ends only
/// itself; one that was stopped (ExitCode::stopped) is the last. Ctrl-C, SIGTERM and SIGUSR1 stop
/// the current one and those after it; SIGUSR2 reaches the current one.
///
/// Returns nothing in a child, with the index of its scene in `scene`; in this process, when all
/// have ended, the exit code of the first one that has not ended with 0. To be called before MPI
/// starts.
std::optional<int> run_each(const std::vector<std::string> &scenes, std::size_t &scene);

/// Forks a child that leads a group of processes and gets `last_signal` when this process ends.
/// Returns what fork() does.
pid_t fork_child(int last_signal);

/// Lets a process that no launcher started run MPI without networks and without a daemon: these take
/// two thirds of the time of `billet --version`. To be made before MPI starts, and to live until it
/// has ended. Other MPIs than Open MPI ignore it.
class ProcessAlone {
public:
  ProcessAlone();
  ~ProcessAlone();
  ProcessAlone(const ProcessAlone &) = delete;
  ProcessAlone &operator=(const ProcessAlone &) = delete;

private:
  std::string folder_; ///< for files of MPI, which processes without a daemon cannot share
};

/// Returns the exit code of a process: `code`, or 0 if launch() reads the code from its file.
/// `is_first`: on the first rank.
int report_exit_code(int code, bool is_first);

} // namespace billet

#endif
