// SPDX-License-Identifier: LGPL-2.1-or-later
// Profiles of lines and arcs as the user defines them, revolved or extruded.
#include "billet/geometry/sector.h"
#include "billet/geometry/swept_profile.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace billet {

namespace {

using Kind = TypeParameter::Kind;
using Point = Profile::Point;

const std::string corners_meaning =
    "Corners of the profile, separated by semicolons. 'x, y' is a corner; ': r' after it adds a fillet of "
    "radius r; 'via x, y to' before it makes an arc instead of a line. ";
const TypeParameter outside_parameter{"Outside", "left", Kind::choice,
                                      "left|right: Side of the bodies, in the direction of the corners."};

/// Reads exactly two numbers; returns false otherwise.
bool read_point(const std::string &text, Point &point) {
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

std::vector<Profile::Segment> read_segments(const TypeInput &input) {
  std::vector<ProfileCorner> corners;
  for (const auto &part : input.parts("Corners"))
    corners.push_back(read_corner(input, part));
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

Profile::Outside read_outside(const TypeInput &input) {
  return input.text("Outside") == "left" ? Profile::Outside::left : Profile::Outside::right;
}

} // namespace

SurfaceType revolved_profile_type() {
  return {"revolved profile",
          "Lines and arcs in a plane through an axis, revolved about it, over a full turn or a sector.",
          with_sector(
              {{"Corners", "", Kind::text,
                corners_meaning + "x >= 0 is the distance from the axis, y the position along it. [length]"},
               outside_parameter,
               {"Origin", "0, 0, 0", Kind::text, "Point of the axis at y = 0. [length]"},
               {"Axis", "0, 0, 1", Kind::text, "Direction of the axis."}}),
          [](const TypeInput &input) {
            const auto segments = read_segments(input);
            const Profile profile(segments, read_outside(input));
            const double tiny = 1e-9 * profile.size();
            if (profile.support(Point({-1., 0.})) > tiny)
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
            return single_patch<ExtrudedProfile>(profile, Axes(input.vector("Origin"), axis, direction),
                                                 -half, half);
          }};
}

} // namespace billet
