// SPDX-License-Identifier: LGPL-2.1-or-later
// Sphere, cylinder, cone and torus: profiles of one arc or one line, revolved, and trimmed along
// the profile and around the axis.
#include "billet/geometry/sector.h"

#include <cmath>

namespace billet {

namespace {

using Kind = TypeParameter::Kind;
using ProfilePoint = Profile::Point;
using ProfileSegment = Profile::Segment;

constexpr double degree = M_PI / 180.;

const TypeParameter axis_parameter{"Axis", "0, 0, 1", Kind::text, "Direction of the axis of revolution."};
std::vector<TypeParameter> with_sector_and_side(std::vector<TypeParameter> parameters) {
  parameters = with_sector(std::move(parameters));
  parameters.push_back(side_parameter);
  return parameters;
}

double in_range(const TypeInput &input, const std::string &key, const double low, const double high,
                const std::string &allowed) {
  const double value = input.number(key);
  if (!(value >= low && value <= high))
    input.reject(key, allowed);
  return value;
}

SurfacePatches revolve(const TypeInput &input, const std::string &origin_key, const Profile &profile) {
  return revolve(input, profile, input.vector(origin_key), input.direction("Axis"));
}

/// Returns the outside of a profile that runs upwards (counter-clockwise, for an arc), with the
/// axis on its left.
Profile::Outside away_from_axis(const TypeInput &input) {
  return side_sign(input) > 0. ? Profile::Outside::right : Profile::Outside::left;
}

} // namespace

SurfaceType sphere_type() {
  return {"sphere", "A sphere, or a zone of it.",
          with_sector_and_side({{"Centre", "0, 0, 0", Kind::text, "Centre of the sphere. [length]"},
                                {"Radius", "1", Kind::number, "> 0. Radius of the sphere. [length]"},
                                axis_parameter,
                                {"From latitude", "-90", Kind::number,
                                 "Latitude at the start of the zone, -90 at the lower pole. [degrees]"},
                                {"To latitude", "90", Kind::number,
                                 "Latitude at the end of the zone, 90 at the upper pole. [degrees]"}}),
          [](const TypeInput &input) {
            const double radius = input.positive("Radius");
            const double from = in_range(input, "From latitude", -90., 90., "a number from -90 to 90");
            const double to = in_range(input, "To latitude", -90., 90., "a number from -90 to 90");
            if (to <= from)
              input.reject("To latitude", "a number above 'From latitude'");
            const ProfileSegment arc =
                ProfileSegment::arc(ProfilePoint(), radius, from * degree, (to - from) * degree);
            return revolve(input, "Centre", Profile({arc}, away_from_axis(input), from == -90., to == 90.));
          }};
}

SurfaceType cylinder_type() {
  return {"cylinder", "A cylinder, infinite unless it has a length.",
          with_sector_and_side(
              {{"Point", "0, 0, 0", Kind::text, "A point of the axis, in the middle of the length. [length]"},
               axis_parameter,
               {"Radius", "1", Kind::number, "> 0. Radius of the cylinder. [length]"},
               {"Length", "", Kind::text, "> 0. Length along the axis. Empty: infinite. [length]"}}),
          [](const TypeInput &input) {
            const double radius = input.positive("Radius");
            std::vector<ProfileSegment> segments;
            if (input.text("Length").empty()) {
              segments = {ProfileSegment::endless_line(ProfilePoint({radius, 0.}), ProfilePoint({0., 1.}))};
            } else {
              const auto length = input.numbers("Length");
              if (length.size() != 1 || !(length[0] > 0.))
                input.reject("Length", "a number > 0, or nothing");
              segments = {ProfileSegment::line(ProfilePoint({radius, -0.5 * length[0]}),
                                               ProfilePoint({radius, 0.5 * length[0]}))};
            }
            return revolve(input, "Point", Profile(segments, away_from_axis(input)));
          }};
}

SurfaceType cone_type() {
  return {"cone", "A cone, or a part of it between two circles.",
          with_sector_and_side(
              {{"Apex", "0, 0, 0", Kind::text, "Apex of the cone. [length]"},
               {"Axis", "0, 0, 1", Kind::text, "Direction of the axis, from the apex into the cone."},
               {"Half angle", "45", Kind::number, "> 0 and < 90. Angle between axis and surface. [degrees]"},
               {"From height", "0", Kind::number,
                ">= 0. Distance of the first circle from the apex, along the axis. [length]"},
               {"To height", "1", Kind::number,
                "> 'From height'. Distance of the second circle from the apex, along the axis. [length]"}}),
          [](const TypeInput &input) {
            const double angle = input.number("Half angle") * degree;
            if (!(angle > 0. && angle < 0.5 * M_PI))
              input.reject("Half angle", "a number > 0 and < 90");
            const double from = input.not_negative("From height"), to = input.number("To height");
            if (!(to > from))
              input.reject("To height", "a number above 'From height'");
            const double slope = std::tan(angle);
            const ProfileSegment line =
                ProfileSegment::line(ProfilePoint({slope * from, from}), ProfilePoint({slope * to, to}));
            return revolve(input, "Apex", Profile({line}, away_from_axis(input), from == 0.));
          }};
}

SurfaceType torus_type() {
  return {"torus", "A torus, or a part of it such as a fillet.",
          with_sector_and_side(
              {{"Centre", "0, 0, 0", Kind::text, "Centre of the ring. [length]"},
               axis_parameter,
               {"Ring radius", "2", Kind::number,
                "> 0. Radius of the circle in the middle of the tube. [length]"},
               {"Tube radius", "1", Kind::number, "> 0. Radius of the tube. [length]"},
               {"From angle", "0", Kind::number,
                "Start of the part in the section of the tube: 0 away from the axis, 90 along it. [degrees]"},
               {"To angle", "360", Kind::number, "End of the part, at most 360 further on. [degrees]"}}),
          [](const TypeInput &input) {
            const double ring = input.positive("Ring radius"), tube = input.positive("Tube radius");
            const double from = input.number("From angle"), to = input.number("To angle");
            if (!(to > from && to - from <= 360.))
              input.reject("To angle", "a number above 'From angle', by at most 360");
            const ProfileSegment arc =
                ProfileSegment::arc(ProfilePoint({ring, 0.}), tube, from * degree, (to - from) * degree);
            // A part that stays away from the axis may have a thick tube.
            const double nearest = -Profile({arc}, Profile::Outside::right).support(ProfilePoint({-1., 0.}));
            if (nearest < -1e-12 * ring)
              input.reject("Tube radius", "a tube that does not cross the axis: at most the ring radius " +
                                              input.text("Ring radius"));
            return revolve(input, "Centre", Profile({arc}, away_from_axis(input)));
          }};
}

} // namespace billet
