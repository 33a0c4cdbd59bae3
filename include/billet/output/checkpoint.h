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

// A checkpoint is an HDF5 file behind a block of 512 bytes of text: format, version of the program, length
// and checksum of the rest. It is written as NAME.tmp, and renamed once it is complete and on disk.
//
// The HDF5 library is called as it is: deal.II's HDF5 classes check its answers in Debug builds only, so that
// a full disk would go unnoticed.

/// Raised whenever what is stored, or how, changes.
constexpr unsigned int checkpoint_format = 7;

/// Writes a checkpoint from all ranks through the first one.
class CheckpointWriter final : public StateWriter {
public:
  CheckpointWriter(MPI_Comm communicator, std::string file_name);
  /// Takes away what was not finished.
  ~CheckpointWriter() override;

  void write(const std::string &name, const std::vector<double> &values) override;
  void write_text(const std::string &name, const std::string &text) override;
  void write_rows(const std::string &name, std::size_t width, const std::vector<std::uint64_t> &keys,
                  const std::vector<double> &values) override;

  /// Makes the file what it is to be. Returns why that failed; empty if it did not. The same on all ranks.
  std::string finish();

private:
  void enter(const std::string &name) override;
  void leave() override;
  /// Notes the first failure; nothing is written after it.
  bool check(bool success, const std::string &what);
  /// Makes the disk keep room for so many more bytes, before HDF5 finds that there is none.
  bool reserve(std::size_t n_bytes);
  void write_array(const std::string &name, long type, std::size_t n_rows, std::size_t width,
                   const void *values);
  void close();
  std::string seal() const;

  MPI_Comm communicator_;
  bool is_first_;
  std::string name_, group_;
  std::string failure_; ///< of the first rank
  long file_ = -1;      ///< of HDF5, on the first rank
};

/// Reads one, on every rank by itself.
class CheckpointReader final : public StateReader {
public:
  /// Throws InputError, which begins with `origin`, where the file is no checkpoint, is damaged, or of
  /// another format or program version.
  CheckpointReader(MPI_Comm communicator, const std::string &file_name, const std::string &origin);
  ~CheckpointReader() override;

  bool has(const std::string &name) const override;
  std::vector<double> read(const std::string &name) const override;
  std::string read_text(const std::string &name) const override;
  std::vector<double> read_rows(const std::string &name, std::size_t width,
                                const std::vector<std::uint64_t> &keys,
                                std::vector<bool> *found) const override;
  unsigned int n_ranks() const override { return n_ranks_; }

  const std::string &file_name() const { return file_name_; }
  /// Calls `load` in a group; what it complains of gets the beginning that says whose fault it is.
  void load(const std::string &group, const std::function<void()> &load);

private:
  void enter(const std::string &name) override;
  void leave() override;

  MPI_Comm communicator_;
  std::string file_name_, origin_, group_;
  unsigned int n_ranks_ = 0;
  long file_ = -1;
};

/// When checkpoints are due, under which names, and how many stay.
class Checkpoints {
public:
  Checkpoints(const parameters::Output &parameters, MPI_Comm communicator);

  bool is_regular() const { return parameters_.checkpoint.is_regular(); }
  /// After so many steps, at this time.
  bool is_due(unsigned int step, double time) const;
  /// Writes the next one, of what `save` saves, and removes those that are too many. Returns why that failed;
  /// then the last ones stay.
  std::string write(double time, const std::function<void(StateWriter &)> &save);
  /// The last one; empty if there is none.
  std::string last() const { return files_.empty() ? "" : files_.back(); }
  /// From within write().
  void save(StateWriter &writer) const;
  /// Goes on behind those of the run that wrote this, whose files are in the same folder or not.
  void load(const StateReader &reader, double time, bool is_same_folder);

private:
  const parameters::Output &parameters_;
  MPI_Comm communicator_;
  unsigned int n_written_ = 0, n_intervals_ = 0;
  std::vector<std::string> files_; ///< that are there, with their folder
};

/// Notices, while it lives, signals that ask the run to end (SIGTERM, SIGINT, SIGUSR1) or to write a
/// checkpoint (SIGUSR2). The second one of a kind does what it always does.
class Signals {
public:
  /// Looks only so often [s]; 0: at each call.
  explicit Signals(MPI_Comm communicator, double seconds_between_looks = 0.);
  ~Signals();
  Signals(const Signals &) = delete;
  Signals &operator=(const Signals &) = delete;

  enum class Wish { none, checkpoint, end };
  /// The strongest wish of any rank, after a step. Collective.
  Wish look();
  /// Name of the signal that wishes the end, for messages.
  const std::string &name() const { return name_; }

private:
  /// Whether enough time has gone by, on the first rank's clock. Collective.
  bool is_time_to_look();

  MPI_Comm communicator_;
  double seconds_between_looks_;
  std::string name_;
  unsigned int n_calls_ = 0, next_look_ = 1;
  std::chrono::steady_clock::time_point last_look_;
};

} // namespace billet

#endif
