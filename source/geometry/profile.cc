// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/profile.h"

#include "billet/geometry/surface_patch.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace billet {

namespace {

using ProfilePoint = Profile::Point;
using ProfileSegment = Profile::Segment;

constexpr double infinity = std::numeric_limits<double>::infinity();
// Tolerances relative to the profile's size: for ends that meet, and for points on an end.
constexpr double meeting = 1e-9, on_the_end = 1e-10;

ProfilePoint left_of(const ProfilePoint &tangent) { return ProfilePoint({-tangent[1], tangent[0]}); }
ProfilePoint at_angle(const double angle) { return ProfilePoint({std::cos(angle), std::sin(angle)}); }
double cross(const ProfilePoint &a, const ProfilePoint &b) { return a[0] * b[1] - a[1] * b[0]; }
double angle_of(const ProfilePoint &a) { return std::atan2(a[1], a[0]); }

/// Returns `angle` modulo 2π, in [0, 2π).
double positive_angle(const double angle) {
  const double turn = 2. * M_PI;
  const double rest = std::fmod(angle, turn);
  return rest < 0. ? rest + turn : rest;
}

} // namespace

ProfileSegment ProfileSegment::line(const ProfilePoint &start, const ProfilePoint &end) {
  ProfileSegment segment;
  segment.start = start;
  segment.end = end;
  return segment;
}

ProfileSegment ProfileSegment::endless_line(const ProfilePoint &point, const ProfilePoint &direction) {
  ProfileSegment segment = line(point, point + direction);
  segment.is_endless = true;
  return segment;
}

ProfileSegment ProfileSegment::arc(const ProfilePoint &centre, const double radius, const double from,
                                   const double sweep) {
  ProfileSegment segment;
  segment.is_arc = true;
  segment.centre = centre;
  segment.radius = radius;
  segment.from = from;
  segment.sweep = sweep;
  segment.start = centre + radius * at_angle(from);
  segment.end = std::abs(sweep) == 2. * M_PI ? segment.start : centre + radius * at_angle(from + sweep);
  return segment;
}

ProfileSegment ProfileSegment::arc_through(const ProfilePoint &start, const ProfilePoint &middle,
                                           const ProfilePoint &end) {
  const ProfilePoint a = middle - start, b = end - start;
  const double area = cross(a, b); // twice the area of the triangle
  if (std::abs(area) <= 1e-12 * std::max(a.norm_square(), b.norm_square()))
    return line(start, end);
  // Circumcentre: (c − start)·a = a²/2, (c − start)·b = b²/2
  const double fa = 0.5 * a.norm_square(), fb = 0.5 * b.norm_square();
  const ProfilePoint arm({(fa * b[1] - fb * a[1]) / area, (fb * a[0] - fa * b[0]) / area});
  const ProfilePoint centre = start + arm;
  const double from = angle_of(start - centre), to = angle_of(end - centre);
  const double left = positive_angle(to - from);
  ProfileSegment segment = arc(centre, arm.norm(), from, area > 0. ? left : left - 2. * M_PI);
  segment.start = start; // exact
  segment.end = end;
  return segment;
}

ProfilePoint ProfileSegment::tangent_at(const ProfilePoint &point) const {
  if (!is_arc)
    return (end - start) / (end - start).norm();
  const ProfilePoint arm = point - centre;
  return (sweep > 0. ? 1. : -1.) * left_of(arm / arm.norm());
}

ProfilePoint ProfileSegment::foot(const ProfilePoint &x) const {
  if (!is_arc) {
    const ProfilePoint along = end - start;
    return start + ((x - start) * along / along.norm_square()) * along;
  }
  const ProfilePoint arm = x - centre;
  const double length = arm.norm();
  return length > 0. ? centre + radius / length * arm : start;
}

bool ProfileSegment::contains(const ProfilePoint &point, const double slack) const {
  if (is_endless)
    return true;
  if (!is_arc) {
    const ProfilePoint along = end - start;
    const double part = (point - start) * along / along.norm();
    return part >= -slack && part <= along.norm() + slack;
  }
  const double turned = positive_angle((sweep > 0. ? 1. : -1.) * (angle_of(point - centre) - from));
  const double angle_slack = slack / radius;
  return turned <= std::abs(sweep) + angle_slack || turned >= 2. * M_PI - angle_slack;
}

Profile::Profile(std::vector<ProfileSegment> segments, const Outside outside, const bool closed_start,
                 const bool closed_end)
    : segments_(std::move(segments)), side_(outside == Outside::left ? 1. : -1.), closed_start_(closed_start),
      closed_end_(closed_end) {
  for (const auto &segment : segments_) {
    size_ = std::max({size_, (segment.end - segment.start).norm(), segment.radius});
    size_ = std::max(size_, (segment.end - segments_.front().start).norm());
  }
  const ProfileSegment &last = segments_.back();
  is_loop_ = (last.end - segments_.front().start).norm() <= meeting * size_;
}

ProfilePoint Profile::normal_at(const ProfileSegment &segment, const ProfilePoint &point) const {
  return side_ * left_of(segment.tangent_at(point));
}

Profile::Closest Profile::at_joint(const ProfilePoint &x, const ProfilePoint &joint,
                                   const ProfilePoint &first_normal, const ProfilePoint &second_normal,
                                   const double curvature) const {
  ProfilePoint normal = first_normal + second_normal;
  const double length = normal.norm();
  normal = length > 1e-6 ? normal / length : first_normal; // arbitrary for a needle
  const ProfilePoint arm = x - joint;
  const double distance = arm.norm();
  const bool is_smooth = std::abs(cross(first_normal, second_normal)) <= 1e-9;
  if (is_smooth || distance <= on_the_end * size_) {
    const double gap = arm * normal;
    return {joint, normal, gap, turned(curvature, gap), false};
  }
  const double gap = arm * normal < 0. ? -distance : distance;
  return {joint, arm / gap, gap, 1. / gap, false};
}

Profile::Closest Profile::closest_point(const ProfilePoint &x) const {
  double best_square = infinity;
  std::size_t best = 0;
  ProfilePoint best_position;
  int best_end = 0; // −1: start of the segment, 1: end, 0: between them
  for (std::size_t s = 0; s < segments_.size(); ++s) {
    const ProfileSegment &segment = segments_[s];
    ProfilePoint position = segment.foot(x);
    int end = 0;
    if (!segment.contains(position, 0.)) {
      const bool is_start = (x - segment.start).norm_square() <= (x - segment.end).norm_square();
      position = is_start ? segment.start : segment.end;
      end = is_start ? -1 : 1;
    }
    const double square = (x - position).norm_square();
    if (square < best_square) {
      best_square = square;
      best = s;
      best_position = position;
      best_end = end;
    }
  }

  const ProfileSegment &segment = segments_[best];
  const ProfilePoint normal = normal_at(segment, best_position);
  const double curvature =
      segment.is_arc ? (normal * (best_position - segment.centre) > 0. ? 1. : -1.) / segment.radius : 0.;
  const ProfilePoint arm = x - best_position;
  const double gap = arm * normal;
  const Closest straight_above = {best_position, normal, gap, turned(curvature, gap), false};
  if (best_end == 0)
    return straight_above;

  // The point is an end of a segment: the chain continues, is mirrored or ends there.
  const bool is_first = best == 0 && best_end < 0, is_last = best + 1 == segments_.size() && best_end > 0;
  if ((is_first || is_last) && !is_loop_) {
    if (is_first ? closed_start_ : closed_end_)
      return at_joint(x, best_position, normal, ProfilePoint({-normal[0], normal[1]}), curvature);
    Closest edge_point = straight_above;
    edge_point.is_beyond_edge = std::abs(arm * segment.tangent_at(best_position)) > on_the_end * size_;
    return edge_point;
  }
  const std::size_t n = segments_.size();
  const ProfileSegment &neighbour = segments_[(best + (best_end < 0 ? n - 1 : 1)) % n];
  return at_joint(x, best_position, normal, normal_at(neighbour, best_position), curvature);
}

double Profile::support(const ProfilePoint &direction) const {
  double result = -infinity;
  for (const auto &segment : segments_) {
    result = std::max({result, segment.start * direction, segment.end * direction});
    if (segment.is_endless && std::abs((segment.end - segment.start) * direction) > 1e-14 * direction.norm())
      return infinity;
    if (segment.is_arc && direction.norm() > 0.) {
      const ProfilePoint top = segment.centre + segment.radius / direction.norm() * direction;
      if (segment.contains(top, 0.))
        result = std::max(result, top * direction);
    }
  }
  return result;
}

std::vector<ProfilePoint> Profile::polyline(const double angle, const ProfilePoint &centre,
                                            const double radius) const {
  std::vector<ProfilePoint> points;
  const auto add = [&](const ProfilePoint &point) {
    if (points.empty() || (points.back() - point).norm() > meeting * size_)
      points.push_back(point);
  };
  for (const auto &segment : segments_) {
    if (segment.is_endless) {
      const ProfilePoint along = segment.end - segment.start;
      const double middle = (centre - segment.start) * along;
      add(segment.start + (middle - radius) * along);
      add(segment.start + (middle + radius) * along);
      continue;
    }
    add(segment.start);
    if (segment.is_arc) {
      const auto n = static_cast<int>(std::ceil(std::abs(segment.sweep) / angle));
      for (int i = 1; i < n; ++i)
        add(segment.centre + segment.radius * at_angle(segment.from + i * segment.sweep / n));
    }
    points.push_back(segment.end);
  }
  return points;
}

namespace {

std::string print(const ProfilePoint &point) {
  std::ostringstream stream;
  stream << "(" << point[0] << ", " << point[1] << ")";
  return stream.str();
}

/// Returns the extended curve at `offset` to the left of a segment.
ProfileSegment offset_curve(const ProfileSegment &segment, const double offset) {
  ProfileSegment result = segment;
  if (segment.is_arc)
    result.radius = segment.radius - (segment.sweep > 0. ? offset : -offset);
  else {
    const ProfilePoint shift = offset * left_of(segment.tangent_at(segment.start));
    result.start += shift;
    result.end += shift;
  }
  return result;
}

std::vector<ProfilePoint> intersections(const ProfileSegment &a, const ProfileSegment &b) {
  if (a.is_arc && !b.is_arc)
    return intersections(b, a);
  if (!a.is_arc && !b.is_arc) {
    const ProfilePoint u = a.end - a.start, v = b.end - b.start;
    const double sine = cross(u, v);
    if (std::abs(sine) <= 1e-14 * u.norm() * v.norm())
      return {};
    return {a.start + cross(b.start - a.start, v) / sine * u};
  }
  // Foot on the line (for two circles, on their radical line) and half a chord.
  ProfilePoint foot, along;
  if (!a.is_arc) {
    foot = a.foot(b.centre);
    along = (a.end - a.start) / (a.end - a.start).norm();
  } else {
    const ProfilePoint d = b.centre - a.centre;
    const double length = d.norm();
    if (length == 0.)
      return {};
    const double part = 0.5 * (length * length + a.radius * a.radius - b.radius * b.radius) / length;
    foot = a.centre + part / length * d;
    along = left_of(d / length);
  }
  const double chord = b.radius * b.radius - (foot - b.centre).norm_square();
  if (chord < 0.)
    return {};
  return {foot + std::sqrt(chord) * along, foot - std::sqrt(chord) * along};
}

/// Returns the fillet of the corner between two segments, and shortens them.
ProfileSegment round_off(ProfileSegment &before, ProfileSegment &after, const double radius) {
  const ProfilePoint corner = before.end;
  const double slack = 1e-9 * std::max(radius, (before.end - before.start).norm());
  bool found = false;
  ProfileSegment best;
  double best_distance = infinity;
  for (const double side : {1., -1.}) {
    // The fillet's centre lies to the left, or to the right, of both.
    const ProfileSegment a = offset_curve(before, side * radius), b = offset_curve(after, side * radius);
    if ((a.is_arc && a.radius <= 0.) || (b.is_arc && b.radius <= 0.))
      continue;
    for (const ProfilePoint &centre : intersections(a, b)) {
      const ProfilePoint first = before.foot(centre), second = after.foot(centre);
      if (!before.contains(first, slack) || !after.contains(second, slack))
        continue;
      const double from = angle_of(first - centre), to = angle_of(second - centre);
      const double left = positive_angle(to - from);
      ProfileSegment fillet = ProfileSegment::arc(centre, radius, from, side > 0. ? left : left - 2. * M_PI);
      fillet.start = first;
      fillet.end = second;
      const double distance = (centre - corner).norm();
      if (std::abs(fillet.sweep) < M_PI && distance < best_distance) {
        found = true;
        best = fillet;
        best_distance = distance;
      }
    }
  }
  if (!found)
    throw std::invalid_argument("the fillet of radius " + std::to_string(radius) + " at " + print(corner) +
                                " does not fit between the neighbouring corners");
  const auto shorten = [](ProfileSegment &segment, const ProfilePoint &start, const ProfilePoint &end) {
    if (segment.is_arc) {
      const double turned =
          positive_angle((segment.sweep > 0. ? 1. : -1.) *
                         (angle_of(end - segment.centre) - angle_of(start - segment.centre)));
      segment.from = angle_of(start - segment.centre);
      segment.sweep = segment.sweep > 0. ? turned : -turned;
    }
    segment.start = start;
    segment.end = end;
  };
  shorten(before, before.start, best.start);
  shorten(after, best.end, after.end);
  return best;
}

/// Returns the distance from x to the nearest point between a and b.
double distance_to(const ProfilePoint &x, const ProfilePoint &a, const ProfilePoint &b) {
  const ProfilePoint along = b - a;
  const double part = std::clamp((x - a) * along / along.norm_square(), 0., 1.);
  return (x - a - part * along).norm();
}

/// Throws if chords of the segments meet other than consecutive ones at their common end, or if
/// these fold back.
void check_crossings(const std::vector<ProfileSegment> &segments) {
  const Profile profile(segments, Profile::Outside::left);
  const std::vector<ProfilePoint> points = profile.polyline(M_PI / 60., ProfilePoint(), 0.);
  const double tolerance = meeting * profile.size();
  const std::size_t n = points.size() - 1; // number of chords
  const bool is_loop = (points.back() - points.front()).norm() <= tolerance;
  const auto side = [](const ProfilePoint &a, const ProfilePoint &b, const ProfilePoint &c) {
    return cross(b - a, c - a);
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const ProfilePoint &a = points[i], &b = points[i + 1], &c = points[j], &d = points[j + 1];
      const bool follows = j == i + 1, closes = is_loop && i == 0 && j + 1 == n;
      if (follows || closes) {
        const ProfilePoint first = follows ? b - a : d - c, second = follows ? d - c : b - a;
        if (first * second < 0. && std::abs(cross(first, second)) <= 1e-9 * first.norm() * second.norm())
          throw std::invalid_argument("it folds back on itself at " + print(follows ? b : a));
        continue;
      }
      if (side(a, b, c) * side(a, b, d) < 0. && side(c, d, a) * side(c, d, b) < 0.)
        throw std::invalid_argument("it crosses itself near " + print(0.5 * (a + b)));
      if (std::min({distance_to(a, c, d), distance_to(b, c, d), distance_to(c, a, b),
                    distance_to(d, a, b)}) <= tolerance)
        throw std::invalid_argument("it touches itself near " + print(0.5 * (a + b)));
    }
}

} // namespace

std::vector<Profile::Segment> connect(const std::vector<ProfileCorner> &corners) {
  if (corners.size() < 2)
    throw std::invalid_argument("a profile needs two points");
  double size = 0.;
  for (const auto &corner : corners)
    size = std::max(size, (corner.position - corners.front().position).norm());
  std::vector<ProfileSegment> legs;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const ProfilePoint &start = corners[i - 1].position, &end = corners[i].position;
    if ((end - start).norm() <= meeting * size)
      throw std::invalid_argument("two points coincide at " + print(end));
    if (corners[i].has_via) {
      // A collinear point between the ends gives a flat arc, a line; elsewhere there is no arc.
      const ProfilePoint along = end - start;
      const double part = (corners[i].via - start) * along / along.norm_square();
      legs.push_back(ProfileSegment::arc_through(start, corners[i].via, end));
      if (!legs.back().is_arc && !(part > meeting && part < 1. - meeting))
        throw std::invalid_argument("no arc leads to " + print(end) + " via " + print(corners[i].via) +
                                    ", which is in line with its ends, but not between them");
      continue;
    }
    legs.push_back(ProfileSegment::line(start, end));
  }
  std::vector<ProfileSegment> segments{legs.front()};
  for (std::size_t i = 1; i < legs.size(); ++i) {
    if (corners[i].fillet > 0.)
      segments.push_back(round_off(segments.back(), legs[i], corners[i].fillet));
    segments.push_back(legs[i]);
  }
  // A line between two fillets may vanish.
  segments.erase(
      std::remove_if(segments.begin(), segments.end(),
                     [size](const ProfileSegment &s) { return (s.end - s.start).norm() <= meeting * size; }),
      segments.end());
  check_crossings(segments);
  return segments;
}

} // namespace billet
