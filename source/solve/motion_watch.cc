// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/motion_watch.h"

#include "billet/algebra/gather.h"
#include "billet/errors.h"

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

/// Limits of what a step may pass over.
struct MotionWatchLimits {
  /// Path over chord above which a step misses the motion: an arc of 15 degrees is 1.00286 times
  /// its chord.
  static constexpr double longer = 1.003;
  /// Path below which a motion does not count, as part of the largest distance from its start in
  /// the run.
  static constexpr double trifle = 0.05;
  /// Number of times at which the motion of the whole run is looked at, and the minimum in a step.
  static constexpr unsigned int per_run = 200, minimum = 16;
};

using Point = std::array<double, 3>;

double distance(const Point &a, const Point &b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

/// Returns times in an interval that match no period, by the golden ratio.
std::vector<double> times_between(const double from, const double to, const unsigned int n) {
  constexpr double golden = 0.61803398874989485;
  std::vector<double> times{from};
  for (unsigned int i = 1; i < n; ++i)
    times.push_back(from + (to - from) * std::fmod(golden * i, 1.));
  std::sort(times.begin(), times.end());
  times.push_back(to);
  return times;
}

} // namespace

MotionWatch::MotionWatch(const Scene &scene, const Supports &supports, const Discretization &discretization)
    : communicator_(discretization.communicator()), end_time_(scene.parameters().time_stepping.end_time) {
  const double rounding = 1e-9 * discretization.radius();
  for (std::size_t i = 0; i < scene.tools().size(); ++i) {
    const Tool &tool = scene.tools()[i];
    if (std::none_of(scene.pairs().begin(), scene.pairs().end(),
                     [i](const ContactPair &pair) { return pair.tool == i; }))
      continue;
    for (unsigned int p = 0; p < 4; ++p) {
      dealii::Point<3> point(tool.placement(0.).to_tool(discretization.centre()));
      if (p < 3)
        point[p] += discretization.radius();
      add({"tool '" + tool.name() + "'",
           [&tool, point](const double t) {
             const auto x = tool.placement(t).to_space(point);
             return Point{x[0], x[1], x[2]};
           },
           tool.removal_time()},
          rounding);
    }
  }
  for (const SupportTrack &motion : supports.moving_nodes())
    add({"a support", [motion](const double t) { return motion.at(t); }, end_time_}, rounding);
}

std::vector<MotionWatch::Point> MotionWatch::places(const Track &track, const std::vector<double> &times) {
  std::vector<Point> found;
  for (const double t : times)
    try {
      found.push_back(track.at(t));
    } catch (const SolutionFailure &) {
      // It has no position at that time. A step that ends there reports it.
    }
  return found;
}

void MotionWatch::add(Track track, const double rounding) {
  const std::vector<Point> points =
      places(track, times_between(0., std::min(end_time_, track.end), MotionWatchLimits::per_run));
  for (const Point &point : points)
    track.extent = std::max(track.extent, distance(point, points.front()));
  if (track.extent > rounding)
    tracks_.push_back(std::move(track));
}

std::string MotionWatch::find_unseen(const double from, const double to) const {
  constexpr double per_run = MotionWatchLimits::per_run;
  constexpr unsigned int minimum = MotionWatchLimits::minimum;
  const auto n = std::max(minimum, static_cast<unsigned int>(std::ceil(per_run * (to - from) / end_time_)));
  const std::vector<double> times = times_between(from, to, n);
  std::string found;
  for (const Track &track : tracks_) {
    if (from >= track.end)
      continue;
    const std::vector<Point> points = places(track, times);
    double path = 0.;
    for (std::size_t i = 1; i < points.size(); ++i)
      path += distance(points[i], points[i - 1]);
    if (path > MotionWatchLimits::trifle * track.extent &&
        path > MotionWatchLimits::longer * distance(points.back(), points.front())) {
      found = track.name;
      break;
    }
  }
  for (const std::string &of_rank : all_gather(communicator_, found))
    if (!of_rank.empty())
      return of_rank;
  return {};
}

} // namespace billet
