// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_MEASUREMENT_INTERVAL_H
#define BILLET_SOLVE_MEASUREMENT_INTERVAL_H

#include <algorithm>

namespace billet {

/// Number of steps between two measurements of errors. It grows while the errors change little.
class MeasurementInterval {
public:
  /// Minimum and maximum number of steps. With fewer steps a measurement costs more than it saves.
  static constexpr unsigned int min = 4, max = 8;
  /// Part of the target below which errors are small and measurements become rare.
  static constexpr double little = 0.1;
  /// Maximum ratio of two successive measurements that agree.
  static constexpr double steady = 2.;
  /// Whether two successive measurements agree.
  static bool is_steady(const double slope, const double last_slope) {
    return slope <= steady * last_slope && slope >= last_slope / steady;
  }

  /// The first measurement is due after `first` steps.
  explicit MeasurementInterval(const unsigned int first) : until_(first) {}

  bool is_due() const { return until_ == 0; }
  void count_step() { until_ -= until_ > 0 ? 1 : 0; }
  /// Starts an interval after a measurement: a longer one, or one of `length` steps.
  void start_longer() { start(std::clamp(2 * length_, min, max)); }
  void start(const unsigned int length) {
    length_ = length;
    repeat();
  }
  /// Starts an interval of the same length as the last.
  void repeat() { until_ = length_; }
  /// Makes the next measurement due after `n_steps` steps, once.
  void wait(const unsigned int n_steps) { until_ = n_steps; }

  unsigned int until() const { return until_; }
  unsigned int length() const { return length_; }
  void load(const unsigned int until, const unsigned int length) {
    until_ = until;
    length_ = length;
  }

private:
  unsigned int until_, length_ = 1;
};

} // namespace billet

#endif
