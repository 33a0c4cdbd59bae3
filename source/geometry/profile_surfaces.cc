// SPDX-License-Identifier: LGPL-2.1-or-later
// Profiles of lines and arcs as the user defines them, revolved or extruded.
#include "billet/geometry/sector.h"
#include "billet/geometry/swept_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace billet {

namespace {

using Kind = TypeParameter::Kind;
using ProfilePoint = Profile::Point;

const std::string corners_meaning =
    "Corners of the profile, separated by semicolons. A corner is 'x, y'. A number ': r' behind it adds a "
    "fillet of radius r. Words 'via x, y to' before it make an arc instead of a line. ";
const TypeParameter outside_parameter{"Outside", "left", Kind::choice,
                                      "left|right: Side of the bodies, in the direction of the corners."};

/// Reads exactly two numbers; returns false otherwise.
bool read_point(const std::string &text, ProfilePoint &point) {
  std::istringstream stream(text);
  char comma = 0;
  std::string rest;
  return (stream >> point[0] >> comma >> point[1]) && comma == ',' && !(stream >> rest) &&
         std::isfinite(point[0]) && std::isfinite(point[1]);
}

bool read_number(const std::string &text, double &number) {
  std::istringstream stream(text);
  std::string rest;
  return (stream >> number) && !(stream >> rest) && std::isfinite(number);
}

ProfileCorner read_corner(const TypeInput &input, const std::string &text) {
  const std::string allowed =
      "'x, y', 'x, y : fillet radius' or 'via x, y to x, y', separated by semicolons; not '" + text + "'";
  ProfileCorner corner;
  std::string rest = text;
  if (rest.compare(0, 4, "via ") == 0) {
    const auto to = rest.find(" to ");
    if (to == std::string::npos || !read_point(rest.substr(4, to - 4), corner.via))
      input.reject("Corners", allowed);
    corner.has_via = true;
    rest = rest.substr(to + 4);
  }
  const auto colon = rest.find(':');
  if (!read_point(rest.substr(0, colon), corner.position))
    input.reject("Corners", allowed);
  if (colon != std::string::npos &&
      !(read_number(rest.substr(colon + 1), corner.fillet) && corner.fillet > 0.))
    input.reject("Corners", "a fillet radius > 0 in '" + text + "'");
  return corner;
}

std::vector<ProfileCorner> read_corners(const TypeInput &input) {
  std::vector<ProfileCorner> corners;
  for (const auto &part : input.parts("Corners"))
    corners.push_back(read_corner(input, part));
  return corners;
}

/// Returns the segments between corners of the user.
std::vector<Profile::Segment> connect_corners(const TypeInput &input,
                                              const std::vector<ProfileCorner> &corners) {
  if (corners.size() < 2)
    input.reject("Corners", "at least two corners");
  if (corners.front().has_via)
    input.reject("Corners", "a first corner without 'via'");
  if (corners.front().fillet > 0. || corners.back().fillet > 0.)
    input.reject("Corners", "fillets between two segments, not at an end");
  std::vector<Profile::Segment> segments;
  try {
    segments = connect(corners);
  } catch (const std::invalid_argument &error) {
    input.reject("Corners", std::string("a profile that can be drawn; ") + error.what());
  }
  return segments;
}

std::vector<Profile::Segment> read_segments(const TypeInput &input) {
  return connect_corners(input, read_corners(input));
}

Profile::Outside read_outside(const TypeInput &input) {
  return input.text("Outside") == "left" ? Profile::Outside::left : Profile::Outside::right;
}

} // namespace

SurfaceType revolved_profile_type() {
  return {"revolved profile",
          "Lines and arcs in a plane through an axis, revolved about it, over a full turn or a sector.",
          with_sector({{"Corners", "", Kind::text,
                        corners_meaning +
                            "The distance from the axis is x >= 0, the position along it is y. [length]"},
                       outside_parameter,
                       {"Origin", "0, 0, 0", Kind::text, "Point of the axis at y = 0. [length]"},
                       {"Axis", "0, 0, 1", Kind::text, "Direction of the axis."}}),
          [](const TypeInput &input) {
            const auto segments = read_segments(input);
            const Profile profile(segments, read_outside(input));
            const double tiny = 1e-9 * profile.size();
            if (profile.support(ProfilePoint({-1., 0.})) > tiny)
              input.reject("Corners", "a profile on one side of the axis, x >= 0");
            const Profile closed(segments, read_outside(input), std::abs(segments.front().start[0]) <= tiny,
                                 std::abs(segments.back().end[0]) <= tiny);
            return revolve(input, closed, input.vector("Origin"), input.direction("Axis"));
          }};
}

SurfaceType extruded_profile_type() {
  return {"extruded profile",
          "Lines and arcs in a plane, extruded across it.",
          {{"Corners", "", Kind::text, corners_meaning + "[length]"},
           outside_parameter,
           {"Origin", "0, 0, 0", Kind::text, "Point at x = y = 0, in the middle of the extrusion. [length]"},
           {"Axis", "0, 0, 1", Kind::text, "Direction of the extrusion."},
           {"Direction", "1, 0, 0", Kind::text,
            "Direction of x. Its component along the axis does not count. y is across both, right-handed."},
           {"Length", "", Kind::text, "> 0. Length of the extrusion. Empty: infinite. [length]"}},
          [](const TypeInput &input) {
            const Profile profile(read_segments(input), read_outside(input));
            const auto axis = input.direction("Axis"), direction = input.direction("Direction");
            if (dealii::cross_product_3d(axis, direction).norm() < 1e-6)
              input.reject("Direction", "a direction across the axis");
            double half = std::numeric_limits<double>::infinity();
            if (!input.text("Length").empty()) {
              const auto length = input.numbers("Length");
              if (length.size() != 1 || !(length[0] > 0.))
                input.reject("Length", "a number > 0, or nothing");
              half = 0.5 * length[0];
            }
            return single_patch<ExtrudedProfile>(
                profile, ProfileAxes(input.vector("Origin"), axis, direction), -half, half);
          }};
}

namespace {

/// Rounded rectangle along which a profile is swept.
struct SweepPath {
  ProfileAxes axes;
  std::array<double, 2> half; ///< half lengths along x and y
  double radius;              ///< of the corners, > 0
};

SweepPath read_path(const TypeInput &input) {
  const auto axis = input.direction("Axis"), direction = input.direction("Direction");
  if (dealii::cross_product_3d(axis, direction).norm() < 1e-6)
    input.reject("Direction", "a direction across the axis");
  const auto lengths = input.numbers("Path lengths");
  if (lengths.size() != 2 || !(lengths[0] > 0.) || !(lengths[1] > 0.))
    input.reject("Path lengths", "two numbers > 0, separated by a comma");
  const double radius = input.positive("Corner radius");
  if (2. * radius > std::min(lengths[0], lengths[1]) * (1. + 1e-12))
    input.reject("Corner radius", "at most half of both 'Path lengths'");
  return {ProfileAxes(input.vector("Origin"), axis, direction), {0.5 * lengths[0], 0.5 * lengths[1]}, radius};
}

/// Adds the four sides, the four corners, and the flat face inside at `height` if it is asked for.
SurfacePatches sweep(const SweepPath &path, const Profile &along_sides, const Profile &around_corners,
                     const bool has_face, const double height, const bool is_up) {
  SurfacePatches patches;
  const ProfileAxes &axes = path.axes;
  for (unsigned int side = 0; side < 4; ++side) {
    const double angle = 0.5 * M_PI * side;
    const dealii::Tensor<1, 3> outwards = std::round(std::cos(angle)) * axes.x +
                                          std::round(std::sin(angle)) * axes.y,
                               forwards = dealii::cross_product_3d(axes.z, outwards);
    const double reach = path.half[side % 2], half = path.half[1 - side % 2] - path.radius;
    if (half > 1e-12 * reach)
      patches.push_back(std::make_unique<ExtrudedProfile>(
          along_sides, ProfileAxes(axes.origin + reach * outwards, -forwards, outwards), -half, half));
    patches.push_back(std::make_unique<RevolvedProfile>(
        around_corners,
        ProfileAxes(axes.origin + (reach - path.radius) * outwards + half * forwards, axes.z, outwards), 0.,
        0.5 * M_PI));
  }
  const std::array<double, 2> inside = {path.half[0] - path.radius, path.half[1] - path.radius};
  if (has_face && std::min(inside[0], inside[1]) > 1e-12 * path.half[0]) {
    const Profile line(
        {Profile::Segment::line(ProfilePoint({-inside[0], height}), ProfilePoint({inside[0], height}))},
        is_up ? Profile::Outside::left : Profile::Outside::right);
    patches.push_back(std::make_unique<ExtrudedProfile>(line, ProfileAxes(axes.origin, -axes.y, axes.x),
                                                        -inside[1], inside[1]));
  }
  return patches;
}

SurfacePatches make_swept(const TypeInput &input) {
  const SweepPath path = read_path(input);
  std::vector<ProfileCorner> corners = read_corners(input);
  const bool has_face = input.text("Inside") == "flat";
  if (has_face && !corners.empty()) {
    if (!(corners.front().position[0] > -path.radius * (1. - 1e-9)))
      input.reject("Corners", "a first corner at x > -'Corner radius', since 'Inside = flat' begins there");
    ProfileCorner start;
    start.position = ProfilePoint({-path.radius, corners.front().position[1]});
    corners.insert(corners.begin(), start);
  }
  const auto segments = connect_corners(input, corners);
  const Profile::Outside outside = read_outside(input);
  const Profile along_sides(segments, outside);
  if (along_sides.support(ProfilePoint({-1., 0.})) > path.radius * (1. + 1e-9))
    input.reject("Corners", "a profile with x >= -'Corner radius' everywhere, so that corners do not fold");
  for (ProfileCorner &corner : corners) {
    corner.position[0] = std::max(0., corner.position[0] + path.radius);
    corner.via[0] += path.radius;
  }
  return sweep(path, along_sides, Profile(connect_corners(input, corners), outside), has_face,
               corners.front().position[1], outside == Profile::Outside::left);
}

} // namespace

SurfaceType swept_profile_type() {
  return {
      "swept profile",
      "Lines and arcs in a plane, swept along a rectangle with rounded corners: a punch, a die or a binder "
      "frame for a drawn box.",
      {{"Corners", "", Kind::text,
        corners_meaning + "The distance outwards from the path is x >= -'Corner radius', the position along "
                          "the axis is y. [length]"},
       outside_parameter,
       {"Path lengths", "2, 2", Kind::text,
        "Lengths of the rectangle along 'Direction' and across it. [length]"},
       {"Corner radius", "0.5", Kind::number,
        "> 0, at most half of both lengths. Radius of the path's corners. [length]"},
       {"Inside", "open", Kind::choice,
        "open|flat: Inside of the path. open: a hole. flat: a flat face at the height of the first corner, "
        "which may have a fillet then."},
       {"Origin", "0, 0, 0", Kind::text, "Centre of the rectangle, at y = 0. [length]"},
       {"Axis", "0, 0, 1", Kind::text, "Direction across the rectangle."},
       {"Direction", "1, 0, 0", Kind::text,
        "Direction of the first length. Its component along the axis does not count."}},
      &make_swept};
}

} // namespace billet
