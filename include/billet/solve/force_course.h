// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_FORCE_COURSE_H
#define BILLET_SOLVE_FORCE_COURSE_H

#include "billet/solve/result_group.h"
#include "billet/state.h"

#include <algorithm>
#include <vector>

namespace billet {

/// Sum of forces S = Σ|F| over time, and its integral, which normalises errors.
class ForceCourse {
public:
  explicit ForceCourse(const double end_time) : end_time_(end_time) {}

  /// Begins at this time.
  void begin(const double time) { time_ = start_ = time; }
  /// Sets the least size that forces count with: errors of forces far below it matter little. It is
  /// a function of the last accepted state, and not part of checkpoints.
  void set_min_size(const double size) { min_size_ = size; }
  /// Returns S of these forces, at least the least size.
  double size_of(const ResultGroup &forces) const { return std::max(billet::size_of(forces), min_size_); }
  /// Adds an accepted step of length `h` at whose end S is `force`.
  void accept(double h, double force);

  double start() const { return start_; }
  double time() const { return time_; }
  double end_time() const { return end_time_; }
  /// Returns the time from start to end.
  double span() const { return end_time_ - start_; }
  /// Returns the remaining time; not negative.
  double left() const { return std::max(0., end_time_ - time_); }
  /// Returns S at the last step.
  double force() const { return force_; }
  /// Returns ∫S dt.
  double work() const { return work_; }
  /// Returns a reference value of the forces: the largest of S now, its mean so far, and its
  /// extrapolated mean.
  double scale() const;

  // For checkpoints.
  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  double end_time_;
  double start_ = 0., time_ = 0.;
  double force_ = 0., force_rate_ = 0.; ///< S, dS/dt in the last step
  double work_ = 0.;
  double min_size_ = 0.;
};

} // namespace billet

#endif
