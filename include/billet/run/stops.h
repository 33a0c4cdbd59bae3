// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_STOPS_H
#define BILLET_RUN_STOPS_H

#include "billet/scene/scene.h"

#include <vector>

namespace billet {

/// Times at which steps of an explicit scene end: those of the scene itself, not those of output.
class Stops {
public:
  explicit Stops(const Scene &scene);

  /// The first after this time.
  double next(double time) const;
  double end() const { return end_; }

private:
  double end_;
  std::vector<double> stops_; ///< ascending; the last is the end
};

/// Times at which a row of the history of an explicit scene is due: the start, the end of the first step that
/// reaches the next multiple of the interval, and the end.
class HistoryTimes {
public:
  explicit HistoryTimes(const parameters::Scene &parameters);

  /// Once for each time.
  bool is_due(double time);

  double last() const { return last_; } ///< multiple that was reached
  double interval() const { return interval_; }
  void begin_after(const double last) { last_ = last; }

private:
  double end_, interval_, last_ = -1.;
};

} // namespace billet

#endif
