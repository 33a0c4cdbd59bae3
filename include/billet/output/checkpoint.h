// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_CHECKPOINT_H
#define BILLET_OUTPUT_CHECKPOINT_H

#include "billet/parameters/control.h"
#include "billet/state.h"

#include <mpi.h>

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace billet {

// A checkpoint is an HDF5 file after a header of 512 bytes of text: format, version of the program,
// length and checksum of the rest. It is written as NAME.tmp and renamed once it is complete and on
// disk.
//
// The HDF5 library is called directly. deal.II's HDF5 classes check its return values in Debug
// builds only, so that a full disk would go unnoticed.

/// Version of the checkpoint's format. Any change of contents or layout increments it.
constexpr unsigned int checkpoint_format = 15;

/// Writes a checkpoint from all ranks through the first one.
class CheckpointWriter final : public StateWriter {
public:
  CheckpointWriter(MPI_Comm communicator, std::string file_name);
  /// Removes an unfinished file.
  ~CheckpointWriter() override;

  void write(const std::string &name, const std::vector<double> &values) override;
  void write_text(const std::string &name, const std::string &text) override;
  void write_rows(const std::string &name, std::size_t width, const std::vector<std::uint64_t> &keys,
                  const std::vector<double> &values) override;

  /// Completes the file. Returns the cause of a failure; empty on success. The same on all ranks.
  std::string finish();

private:
  void enter(const std::string &name) override;
  void leave() override;
  /// Records the first failure and returns whether there is none. Nothing is written after a
  /// failure.
  bool check(bool success, const std::string &what);
  /// Reserves disk space for this number of further bytes, before HDF5 can run out of it.
  bool reserve(std::size_t n_bytes);
  void write_array(const std::string &name, long type, std::size_t n_rows, std::size_t width,
                   const void *values);
  void close();
  std::string seal() const;

  MPI_Comm communicator_;
  bool is_first_;
  std::string name_, group_;
  std::string failure_; ///< on the first rank
  long file_ = -1;      ///< HDF5 identifier, on the first rank
};

/// Reads a checkpoint, on every rank independently.
class CheckpointReader final : public StateReader {
public:
  /// Opens the file. Throws InputError, which begins with `origin`, if it is no checkpoint, is
  /// damaged, or has another format or program version.
  CheckpointReader(MPI_Comm communicator, const std::string &file_name, const std::string &origin);
  ~CheckpointReader() override;

  bool has(const std::string &name) const override;
  using StateReader::read;
  std::vector<double> read(const std::string &name) const override;
  std::string read_text(const std::string &name) const override;
  std::vector<double> read_rows(const std::string &name, std::size_t width,
                                const std::vector<std::uint64_t> &keys,
                                std::vector<bool> *found) const override;
  std::size_t n_rows(const std::string &name) const override;
  unsigned int n_ranks() const override { return n_ranks_; }

  const std::string &file_name() const { return file_name_; }
  /// Calls `load` inside a group. Extends its InputError by the file name and the statement that
  /// the checkpoint does not fit the scene.
  void load(const std::string &group, const std::function<void()> &load);

private:
  void enter(const std::string &name) override;
  void leave() override;

  MPI_Comm communicator_;
  std::string file_name_, origin_, group_;
  unsigned int n_ranks_ = 0;
  long file_ = -1;
};

/// Schedule, names and number of checkpoints.
class Checkpoints {
public:
  Checkpoints(const parameters::Output &parameters, MPI_Comm communicator);

  bool is_regular() const { return parameters_.checkpoint.is_regular(); }
  /// Whether a checkpoint is due after this number of steps, at this time.
  bool is_due(unsigned int step, double time) const;
  /// Writes the next checkpoint with the state from `save`, and removes the oldest ones in excess.
  /// Returns the cause of a failure, which keeps the last ones; empty on success.
  std::string write(double time, const std::function<void(StateWriter &)> &save);
  /// Returns the last checkpoint; empty if there is none.
  std::string last() const { return files_.empty() ? "" : files_.back(); }
  /// Saves the schedule. Called from within write().
  void save(StateWriter &writer) const;
  /// Continues the schedule of the run that wrote the state. If the folder is the same, continues
  /// the numbers of its files, too.
  void load(const StateReader &reader, double time, bool is_same_folder);

private:
  const parameters::Output &parameters_;
  MPI_Comm communicator_;
  unsigned int n_written_ = 0, n_intervals_ = 0;
  std::vector<std::string> files_; ///< existing files, with their folder
};

/// Catches, during its lifetime, signals that request the end of the run (SIGTERM, SIGINT, SIGUSR1)
/// or a checkpoint (SIGUSR2). A second SIGTERM or SIGINT has its default effect.
class Signals {
public:
  /// Installs the handlers. `seconds_between_checks`: interval of the checks [s]; 0: at each call.
  explicit Signals(MPI_Comm communicator, double seconds_between_checks = 0.);
  ~Signals();
  Signals(const Signals &) = delete;
  Signals &operator=(const Signals &) = delete;

  enum class Request { none, checkpoint, end };
  /// Returns the strongest request of any rank, after a step. Collective.
  Request poll();
  /// Returns the name of the signal that requests the end, for messages.
  const std::string &name() const { return name_; }

private:
  /// Whether enough time has passed, by the first rank's clock. Collective.
  bool is_time_to_check();

  MPI_Comm communicator_;
  double seconds_between_checks_;
  std::string name_;
  unsigned int n_calls_ = 0, next_check_ = 1;
  std::chrono::steady_clock::time_point last_check_;
};

} // namespace billet

#endif
