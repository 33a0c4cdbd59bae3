// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/stops.h"

#include "billet/times.h"

#include <algorithm>
#include <cmath>

namespace billet {

Stops::Stops(const Scene &scene) : end_(scene.parameters().time_stepping.end_time), stops_(scene.stops()) {
  const auto &more = scene.parameters().time_stepping.stops;
  stops_.insert(stops_.end(), more.begin(), more.end());
  // A stop that differs from the end only by round-off is the end.
  stops_.erase(std::remove_if(stops_.begin(), stops_.end(),
                              [this](const double stop) { return !times::is_before(stop, end_); }),
               stops_.end());
  stops_.push_back(end_);
  std::sort(stops_.begin(), stops_.end());
}

double Stops::next(const double time) const {
  return *std::upper_bound(stops_.begin(), stops_.end() - 1, time);
}

bool RegularTimes::is_due(const double time) {
  const double n = times::count_intervals(time, interval_);
  const bool is_due = n > last_ || time >= end_;
  last_ = std::max(n, last_);
  return is_due;
}

} // namespace billet
