// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/approach.h"

#include "billet/algebra/gather.h"
#include "billet/errors.h"
#include "billet/geometry/rigid_surface.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace billet {

using dealii::Tensor;
namespace mpi = dealii::Utilities::MPI;

namespace {

/// Settings of the search for contact.
struct Search {
  static constexpr unsigned int min_samples = 200, max_samples = 1000;
  /// Motion between samples [facet sizes]: less than the penetration at which a point no longer
  /// faces a facet.
  static constexpr double motion = 0.25;
  /// Gap of points that count as meeting with the first one [facet sizes].
  static constexpr double together = 1e-6;
  /// Length of the interval at which bisection ends, relative to the time.
  static constexpr double resolution = 1e-13;
};

BoundingBox box_of(const std::vector<Tensor<1, 3>> &points) {
  BoundingBox box = BoundingBox::empty();
  for (const auto &point : points)
    box.add(point);
  return box;
}

/// Returns the maximum motion of points in the box, seen from the surface, between two placements.
/// The motion is affine in the point, so that a corner has the maximum.
double max_motion(const BoundingBox &box, const Placement &from, const Placement &to) {
  double maximum = 0.;
  for (unsigned int corner = 0; corner < 8; ++corner) {
    Tensor<1, 3> x;
    for (unsigned int i = 0; i < 3; ++i)
      x[i] = (corner & (1U << i)) != 0 ? box.high[i] : box.low[i];
    maximum = std::max(maximum, (to.to_tool(x) - from.to_tool(x)).norm());
  }
  return maximum;
}

/// The points of a side that this rank measures, with lower bounds of their distances. A point
/// whose distance exceeds the motion since it was measured cannot touch.
class TrackedSide {
public:
  TrackedSide(const GapSide &side, const MPI_Comm communicator)
      : side_(side), box_(box_of(side.points)), first_(mpi::this_mpi_process(communicator)),
        stride_(mpi::n_mpi_processes(communicator)), bounds_(side.points.size(), 0.),
        patches_(side.points.size(), 0) {}

  /// Moves on to the placement, and measures the points that may be within `tolerance` there.
  /// Returns whether one is.
  bool advance(const Placement &placement, const double tolerance) {
    path_ += is_placed_ && !side_.points.empty() ? max_motion(box_, before_, placement) : 0.;
    before_ = placement;
    is_placed_ = true;
    near_.clear();
    bool touches = false;
    for (std::size_t i = first_; i < side_.points.size(); i += stride_) {
      if (bounds_[i] > path_ + tolerance)
        continue;
      near_.push_back(i);
      const PointGap point = side_.gap_of(i, placement, patches_[i]);
      patches_[i] = point.patch;
      bounds_[i] = path_ + point.distance;
      touches = touches || (point.faces && point.gap <= tolerance);
    }
    return touches;
  }

  /// Calls visit(point) for the points, among those that the last advance() measured, that are
  /// within `tolerance` at this placement.
  template <class Visit>
  void visit_touching(const Placement &placement, const double tolerance, const Visit &visit) const {
    for (const std::size_t i : near_) {
      const PointGap point = side_.gap_of(i, placement, patches_[i]);
      if (point.faces && point.gap <= tolerance)
        visit(i);
    }
  }

  const GapSide &side() const { return side_; }
  const BoundingBox &box() const { return box_; }

private:
  const GapSide &side_;
  BoundingBox box_;
  std::size_t first_, stride_;
  /// Path at which the point may touch, at the earliest [length].
  std::vector<double> bounds_;
  std::vector<unsigned int> patches_; ///< see PointGap
  std::vector<std::size_t> near_;
  Placement before_;
  bool is_placed_ = false;
  double path_ = 0.; ///< sum of motions since time 0 [length]
};

/// The sides of a pair in the search for contact.
class Approach {
public:
  Approach(const std::vector<GapSide> &sides, const MPI_Comm communicator) : communicator_(communicator) {
    for (const GapSide &side : sides)
      sides_.emplace_back(side, communicator);
  }

  /// Returns the times of the samples, up to the end or to where the motions are undefined.
  std::vector<double> sample_times(const ApproachSpan &span) const {
    std::vector<double> times = times_of(span, Search::min_samples);
    double path = 0., end = 0.;
    for (std::size_t k = 1; k < times.size(); ++k)
      try {
        path += motion(times[k - 1], times[k]);
        end = times[k];
      } catch (const SolutionFailure &) { // the run will report it
        break;
      }
    const double wanted = std::ceil(path / (Search::motion * span.size));
    if (wanted > Search::min_samples)
      times = times_of(span, static_cast<unsigned int>(std::min<double>(wanted, Search::max_samples)));
    times.erase(std::upper_bound(times.begin(), times.end(), end), times.end());
    return times;
  }

  bool advance(const double t, const double tolerance) {
    bool touches = false;
    for (TrackedSide &side : sides_)
      touches = side.advance(side.side().placement(t), tolerance) || touches;
    return on_any_rank(touches);
  }

  bool touches(const double t, const double tolerance) const {
    bool touches = false;
    for (const TrackedSide &side : sides_)
      side.visit_touching(side.side().placement(t), tolerance, [&](std::size_t) { touches = true; });
    return on_any_rank(touches);
  }

  MeetingReport describe(const double t, const double tolerance) const {
    MeetingReport report;
    report.time = t;
    constexpr double none = std::numeric_limits<double>::infinity();
    // Number of the first point, its position, number of all.
    std::array<double, 5> own{none, 0., 0., 0., 0.};
    double offset = 0.;
    for (const TrackedSide &side : sides_) {
      side.visit_touching(side.side().placement(t), tolerance, [&](const std::size_t i) {
        own[4] += 1.;
        const double number = offset + static_cast<double>(i);
        if (number < own[0]) {
          const Tensor<1, 3> &x = side.side().points[i];
          own = {number, x[0], x[1], x[2], own[4]};
        }
      });
      offset += static_cast<double>(side.side().points.size());
    }
    double first = none;
    for (const auto &of_rank : all_gather(communicator_, own)) {
      report.n_nodes += static_cast<std::size_t>(of_rank[4]);
      if (of_rank[0] < first) {
        first = of_rank[0];
        report.first = Tensor<1, 3>({of_rank[1], of_rank[2], of_rank[3]});
      }
    }
    return report;
  }

private:
  static std::vector<double> times_of(const ApproachSpan &span, const unsigned int n) {
    std::vector<double> times;
    for (unsigned int k = 0; k <= n; ++k)
      times.push_back(span.end * k / n);
    for (const double stop : span.stops)
      if (stop > 0. && stop < span.end)
        times.push_back(stop);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
  }

  double motion(const double from, const double to) const {
    double maximum = 0.;
    for (const TrackedSide &side : sides_)
      if (!side.side().points.empty())
        maximum =
            std::max(maximum, max_motion(side.box(), side.side().placement(from), side.side().placement(to)));
    return maximum;
  }

  bool on_any_rank(const bool value) const { return mpi::max(value ? 1 : 0, communicator_) > 0; }

  MPI_Comm communicator_;
  std::vector<TrackedSide> sides_;
};

} // namespace

PointGap GapSide::gap_of(const std::size_t i, const Placement &placement, const unsigned int patch) const {
  constexpr double away = 0.1; // cosine; 0 along the surface
  PointGap point = measure(placement.to_tool(points[i]), patch);
  point.faces = point.faces && normals[i] * (placement.rotation * point.outward) <= away;
  return point;
}

GapReport measure_gaps(const std::vector<GapSide> &sides, const double t, const MPI_Comm communicator) {
  GapReport report;
  const std::size_t first = mpi::this_mpi_process(communicator), stride = mpi::n_mpi_processes(communicator);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  // Gap, number of the point, its position.
  std::array<double, 5> least{infinity, infinity, 0., 0., 0.};
  std::vector<double> sums(2, 0.); // facing points, their gaps
  std::size_t offset = 0;
  for (const GapSide &side : sides) {
    const Placement placement = side.placement(t);
    for (std::size_t i = first; i < side.points.size(); i += stride) {
      const Tensor<1, 3> &x = side.points[i];
      const PointGap point = side.gap_of(i, placement);
      if (!point.faces)
        continue;
      sums[0] += 1.;
      sums[1] += point.gap;
      least = std::min(least, {point.gap, static_cast<double>(offset + i), x[0], x[1], x[2]});
    }
    offset += side.points.size();
  }
  mpi::sum(sums, communicator, sums);
  for (const auto &of_rank : all_gather(communicator, least))
    least = std::min(least, of_rank);
  report.n_nodes = offset;
  report.n_facing = static_cast<std::size_t>(sums[0]);
  if (report.n_facing == 0)
    return report;
  report.least = least[0];
  report.mean = sums[1] / sums[0];
  report.nearest = Tensor<1, 3>({least[2], least[3], least[4]});
  return report;
}

std::optional<MeetingReport> find_meeting(const std::vector<GapSide> &sides, const ApproachSpan &span,
                                          const MPI_Comm communicator) {
  const double tolerance = touching_gap * span.size, together = Search::together * span.size;
  Approach approach(sides, communicator);
  double before = 0.;
  for (const double t : approach.sample_times(span)) {
    if (approach.advance(t, tolerance)) {
      double late = t;
      while (late - before > Search::resolution * late) {
        const double middle = 0.5 * (before + late);
        if (middle <= before || middle >= late)
          break;
        (approach.touches(middle, tolerance) ? late : before) = middle;
      }
      return approach.describe(late, together);
    }
    before = t;
  }
  return {};
}

} // namespace billet
