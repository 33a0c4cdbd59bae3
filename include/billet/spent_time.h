// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SPENT_TIME_H
#define BILLET_SPENT_TIME_H

#include <array>
#include <chrono>
#include <cstddef>

namespace billet {

/// Kinds of work that a run may do without need.
enum class Work {
  unsymmetric_matrix, ///< factorisations and solves with it
  self_contact,       ///< search and forces
  fields,             ///< their output
  error_control,      ///< steps that are only compared
  limited_steps,      ///< steps of the scene's own 'Maximum step', beside a target error
  n
};

/// Wall-clock time that this process has spent on each kind of work [s].
class SpentTime {
public:
  static double on(const Work work) { return seconds[static_cast<std::size_t>(work)]; }
  /// Returns the time since the program began.
  static double on_all();

private:
  friend class TimedWork;
  static std::array<double, static_cast<std::size_t>(Work::n)> seconds;
};

/// Adds the time of its life to a kind of work, if `counts`.
class TimedWork {
public:
  explicit TimedWork(const Work work, const bool counts = true)
      : work_(work), counts_(counts), start_(std::chrono::steady_clock::now()) {}
  TimedWork(const TimedWork &) = delete;
  TimedWork &operator=(const TimedWork &) = delete;
  ~TimedWork() {
    if (counts_)
      SpentTime::seconds[static_cast<std::size_t>(work_)] +=
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

private:
  Work work_;
  bool counts_;
  std::chrono::steady_clock::time_point start_;
};

} // namespace billet

#endif
