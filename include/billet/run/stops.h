// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_STOPS_H
#define BILLET_RUN_STOPS_H

#include "billet/scene/scene.h"

#include <vector>

namespace billet {

/// Times at which steps of an explicit scene end: only the stops of the scene, not those of output.
class Stops {
public:
  explicit Stops(const Scene &scene);

  /// Returns the first stop after this time.
  double next(double time) const;
  double end() const { return end_; }

private:
  double end_;
  std::vector<double> stops_; ///< ascending; the last is the end
};

/// Schedule of what an explicit scene does at intervals. These are the start, the end of the first
/// step that reaches the next multiple of the interval, and the end.
class RegularTimes {
public:
  static constexpr double n_by_default = 200.;
  /// `interval`: 0 for the time to the end over `n_by_default` [time].
  RegularTimes(const double end, const double interval)
      : end_(end), interval_(interval > 0. ? interval : end / n_by_default) {}

  /// Whether something is due at this time. Call it once for each time.
  bool is_due(double time);

  double last() const { return last_; } ///< multiple of the interval reached last
  double interval() const { return interval_; }
  void begin_after(const double last) { last_ = last; }

private:
  double end_, interval_, last_ = -1.;
};

} // namespace billet

#endif
