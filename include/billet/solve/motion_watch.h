// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_MOTION_WATCH_H
#define BILLET_SOLVE_MOTION_WATCH_H

#include "billet/discretization/supports.h"
#include "billet/scene/scene.h"

#include <functional>
#include <string>
#include <vector>

namespace billet {

/// Finds prescribed motions that a step would not see, since it knows them at its ends only: to and fro, or
/// around. Of each tool with a contact pair it follows four points, of the supports some nodes. A step is too
/// long for a point if its path is longer than the straight way by more than that of an arc of 15 degrees,
/// and is no trifle beside all that the point does in the run.
class MotionWatch {
public:
  /// Collective.
  MotionWatch(const Scene &scene, const Supports &supports, const Discretization &discretization);

  /// What moves so between these times, in words ("tool 'punch'", "a support"); empty if nothing does.
  /// Collective.
  std::string find_unseen(double from, double to) const;

private:
  using Point = std::array<double, 3>;
  struct Track {
    std::string name;
    std::function<Point(double)> at;
    double end;         ///< from when on it is gone
    double extent = 0.; ///< largest distance from where it starts, in the whole run [length]
  };
  /// What moves no further than `rounding`, as a point on the axis of rotation, is at rest.
  void add(Track track, double rounding);
  /// Where it is at these times, without those at which its motion has no value.
  static std::vector<Point> places(const Track &track, const std::vector<double> &times);

  MPI_Comm communicator_;
  double end_time_;
  std::vector<Track> tracks_; ///< of this rank; those of tools on all
};

} // namespace billet

#endif
