// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_PROFILE_H
#define BILLET_GEOMETRY_PROFILE_H

#include <deal.II/base/tensor.h>

#include <limits>
#include <vector>

namespace billet {

/// A chain of lines and arcs in a plane, to be revolved or extruded.
class Profile {
public:
  using Point = dealii::Tensor<1, 2>;

  /// Which side of the chain, walked along, is outside of the tool.
  enum class Outside { left, right };

  /// A line from `start` to `end`, or an arc about `centre`: from angle `from` [radians] over `sweep`,
  /// positive when counter-clockwise.
  struct Segment {
    Point start, end;
    bool is_endless = false; ///< a line through start and end
    bool is_arc = false;
    Point centre;
    double radius = 0., from = 0., sweep = 0.;

    static Segment line(const Point &start, const Point &end);
    /// Through `point`, `direction` a unit vector.
    static Segment endless_line(const Point &point, const Point &direction);
    static Segment arc(const Point &centre, double radius, double from, double sweep);
    /// The arc from `start` to `end` through `middle`; a line if the three are in line.
    static Segment arc_through(const Point &start, const Point &middle, const Point &end);

    /// Unit tangent where `point` of the segment is.
    Point tangent_at(const Point &point) const;
    /// Nearest point of the segment if it had no ends.
    Point foot(const Point &x) const;
    /// Whether a point of the endless segment lies between its ends; `slack` [length].
    bool contains(const Point &point, double slack) const;
  };

  /// Each segment begins where the one before ends. `closed_start`, `closed_end`: the surface goes on beyond
  /// that end as its own mirror image, as on an axis of revolution; it is no border.
  Profile(std::vector<Segment> segments, Outside outside, bool closed_start = false, bool closed_end = false);

  /// The nearest point, in the plane.
  struct Closest {
    Point position, normal;
    double gap;
    double turning; ///< ∂n/∂x along the profile, as of ClosestPoint
    bool is_beyond_border;
  };
  Closest closest_point(const Point &x) const;

  /// Largest p · `direction` over the points p of the profile; may be infinite.
  double support(const Point &direction) const;

  /// Points along the profile in pieces of at most `angle` [radians] of an arc, endless lines cut at `radius`
  /// from `centre`.
  std::vector<Point> polyline(double angle, const Point &centre, double radius) const;

  const std::vector<Segment> &segments() const { return segments_; }
  /// Something like its extent [length].
  double size() const { return size_; }

private:
  Point normal_at(const Segment &segment, const Point &point) const;
  Closest at_joint(const Point &x, const Point &joint, const Point &first_normal, const Point &second_normal,
                   double curvature) const;

  std::vector<Segment> segments_;
  double side_; ///< of the normal: 1 left, −1 right
  bool closed_start_, closed_end_, is_loop_ = false;
  double size_ = 0.;
};

/// A corner of a profile as a user draws it.
struct ProfileCorner {
  Profile::Point position;
  double fillet = 0.;   ///< radius, 0 for a sharp corner
  bool has_via = false; ///< an arc leads here, through `via`, instead of a line
  Profile::Point via;
};

/// The segments between the corners, in their order, fillets inserted. Throws std::invalid_argument, with the
/// reason, where corners coincide, a point that an arc leads through is in line with its ends but not between
/// them, a fillet does not fit between its neighbours, or the profile crosses, touches or folds back on
/// itself (arcs as chords of at most 3 degrees).
std::vector<Profile::Segment> connect(const std::vector<ProfileCorner> &corners);

} // namespace billet

#endif
