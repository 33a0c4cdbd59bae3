// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_PROFILE_H
#define BILLET_GEOMETRY_PROFILE_H

#include <deal.II/base/tensor.h>

#include <limits>
#include <vector>

namespace billet {

/// Chain of lines and arcs in a plane, to be revolved or extruded.
class Profile {
public:
  using Point = dealii::Tensor<1, 2>;

  /// Side of the chain, seen along its direction, that is outside the tool.
  enum class Outside { left, right };

  /// Line from `start` to `end`, or arc about `centre` from the angle `from` [radians] over
  /// `sweep`, positive counter-clockwise.
  struct Segment {
    Point start, end;
    bool is_endless = false; ///< infinite line through start and end
    bool is_arc = false;
    Point centre;
    double radius = 0., from = 0., sweep = 0.;

    static Segment line(const Point &start, const Point &end);
    /// Returns an infinite line through `point`; `direction` is a unit vector.
    static Segment endless_line(const Point &point, const Point &direction);
    static Segment arc(const Point &centre, double radius, double from, double sweep);
    /// Returns the arc from `start` to `end` through `middle`; a line if the three are collinear.
    static Segment arc_through(const Point &start, const Point &middle, const Point &end);

    /// Returns the unit tangent at `point` of the segment.
    Point tangent_at(const Point &point) const;
    /// Returns the nearest point of the segment extended beyond its ends.
    Point foot(const Point &x) const;
    /// Whether a point of the extended segment lies between its ends, within `slack` [length].
    bool contains(const Point &point, double slack) const;
  };

  /// Makes a profile of segments, each beginning at the end of the previous one. With
  /// `closed_start` or `closed_end` the surface continues beyond that end as its own mirror image,
  /// as on an axis of revolution. That end is no edge.
  Profile(std::vector<Segment> segments, Outside outside, bool closed_start = false, bool closed_end = false);

  /// Nearest point, in the plane.
  struct Closest {
    Point position, normal;
    double gap;
    double turning; ///< ∂n/∂x along the profile, as in ClosestPoint
    bool is_beyond_edge;
  };
  Closest closest_point(const Point &x) const;

  /// Returns the maximum of p · `direction` over the points p of the profile; may be infinite.
  double support(const Point &direction) const;

  /// Returns points along the profile, at most `angle` [radians] of an arc apart. Infinite lines
  /// are cut at `radius` from `centre`.
  std::vector<Point> polyline(double angle, const Point &centre, double radius) const;

  const std::vector<Segment> &segments() const { return segments_; }
  /// Returns a characteristic size of the profile [length].
  double size() const { return size_; }

private:
  Point normal_at(const Segment &segment, const Point &point) const;
  Closest at_joint(const Point &x, const Point &joint, const Point &first_normal, const Point &second_normal,
                   double curvature) const;

  std::vector<Segment> segments_;
  double side_; ///< side of the normal: 1 left, −1 right
  bool closed_start_, closed_end_, is_loop_ = false;
  double size_ = 0.;
};

/// Corner of a profile as the user defines it.
struct ProfileCorner {
  Profile::Point position;
  double fillet = 0.;   ///< radius, 0 for a sharp corner
  bool has_via = false; ///< an arc through `via` ends here, instead of a line
  Profile::Point via;
};

/// Returns the segments between the corners, in their order, with fillets inserted. Throws
/// std::invalid_argument, with the reason, if corners coincide or a fillet does not fit between its
/// neighbours. It also throws if the `via` point of an arc is collinear with its ends but not
/// between them. The same holds if the profile crosses, touches or folds back on itself (arcs as
/// chords of at most 3 degrees).
std::vector<Profile::Segment> connect(const std::vector<ProfileCorner> &corners);

} // namespace billet

#endif
