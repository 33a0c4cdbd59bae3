// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_MOTION_WATCH_H
#define BILLET_SOLVE_MOTION_WATCH_H

#include "billet/discretization/supports.h"
#include "billet/scene/scene.h"

#include <functional>
#include <string>
#include <vector>

namespace billet {

/// Finds prescribed motions, such as oscillations or full turns, that a step misses because it
/// samples them at its ends only. It follows four points of each tool with a contact pair, and some
/// nodes of the supports. A step is too long if a point's path exceeds the chord by more than that
/// of an arc of 15 degrees. Paths that are small compared with the point's motion in the whole run
/// do not count.
class MotionWatch {
public:
  /// Collective.
  MotionWatch(const Scene &scene, const Supports &supports, const Discretization &discretization);

  /// Returns the name of an object with such a motion between these times ("tool 'punch'", "a
  /// support"); empty if there is none. Collective.
  std::string find_unseen(double from, double to) const;

private:
  using Point = std::array<double, 3>;
  struct Track {
    std::string name;
    std::function<Point(double)> at;
    double end;         ///< time at which it is removed
    double extent = 0.; ///< largest distance from its start, in the whole run [length]
  };
  /// Adds a track. A point that moves no further than `rounding`, such as one on the axis of
  /// rotation, is at rest and left out.
  void add(Track track, double rounding);
  /// Returns the positions at these times, except times at which the motion has no value.
  static std::vector<Point> places(const Track &track, const std::vector<double> &times);

  MPI_Comm communicator_;
  double end_time_;
  std::vector<Track> tracks_; ///< of this rank; those of tools on all
};

} // namespace billet

#endif
