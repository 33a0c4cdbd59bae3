// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/plane.h"

#include "billet/geometry/frame.h"
#include "billet/geometry/sector.h"
#include "billet/geometry/swept_profile.h"

#include <array>

namespace billet {

using dealii::Tensor;
using Kind = TypeParameter::Kind;

BoundingBox Plane::bounding_box() const {
  BoundingBox box;
  for (unsigned int i = 0; i < 3; ++i) {
    const bool is_flat = std::abs(normal_[i]) == 1.; // to the last bit
    const double reach = std::numeric_limits<double>::infinity();
    box.low[i] = is_flat ? point_[i] : -reach;
    box.high[i] = is_flat ? point_[i] : reach;
  }
  return box;
}

void Plane::draw(const OutputRegion &region, SurfaceMesh &surface_mesh) const {
  const auto foot = closest_point(region.centre).position;
  const Frame frame = Frame::from_normal(normal_);
  const auto first = static_cast<unsigned int>(surface_mesh.points.size());
  for (const auto &corner : {std::array<double, 2>{-1., -1.}, {1., -1.}, {1., 1.}, {-1., 1.}})
    surface_mesh.points.push_back(foot + region.radius * (corner[0] * frame.q + corner[1] * frame.r));
  surface_mesh.facets.push_back({first, first + 1, first + 2, first + 3});
}

namespace {

const TypeParameter normal_parameter{"Normal", "0, 0, 1", Kind::text,
                                     "Normal of the tool, towards the bodies."};

/// Returns a line along x with the normal y; closed if it begins on the axis of revolution.
Profile flat_profile(const double from, const double to, const bool is_closed = false) {
  return Profile({Profile::Segment::line(Profile::Point({from, 0.}), Profile::Point({to, 0.}))},
                 Profile::Outside::left, is_closed);
}

} // namespace

SurfaceType plane_type() {
  return {"plane",
          "An infinite plane.",
          {{"Point", "0, 0, 0", Kind::text, "A point of the plane. [length]"}, normal_parameter},
          [](const TypeInput &input) {
            return single_patch<Plane>(input.vector("Point"), input.direction("Normal"));
          }};
}

SurfaceType rectangle_type() {
  return {"rectangle",
          "A rectangle.",
          {{"Centre", "0, 0, 0", Kind::text, "Centre of the rectangle. [length]"},
           normal_parameter,
           {"Direction", "1, 0, 0", Kind::text,
            "Direction of the sides of this length. Its component along the normal does not count."},
           {"Length", "1", Kind::number, "> 0. Length of two sides. [length]"},
           {"Width", "1", Kind::number, "> 0. Length of the other sides. [length]"}},
          [](const TypeInput &input) {
            const auto normal = input.direction("Normal"), direction = input.direction("Direction");
            if (dealii::cross_product_3d(normal, direction).norm() < 1e-6)
              input.reject("Direction", "a direction across the normal");
            const double length = input.positive("Length"), width = input.positive("Width");
            // Profile along x, normal along y: extruded along x × n.
            ProfileAxes axes(input.vector("Centre"), normal, direction);
            axes.y = normal;
            axes.z = dealii::cross_product_3d(axes.x, axes.y);
            return single_patch<ExtrudedProfile>(flat_profile(-0.5 * length, 0.5 * length), axes,
                                                 -0.5 * width, 0.5 * width);
          }};
}

SurfaceType disc_type() {
  return {"disc", "A disc or a ring, or a sector of one.",
          with_sector({{"Centre", "0, 0, 0", Kind::text, "Centre of the disc. [length]"},
                       {"Normal", "0, 0, 1", Kind::text,
                        "Normal of the tool, towards the bodies, which is the axis of a sector."},
                       {"Radius", "1", Kind::number, "> 0. Radius of the disc. [length]"},
                       {"Inner radius", "0", Kind::number, ">= 0. Radius of the hole. [length]"}}),
          [](const TypeInput &input) {
            const double radius = input.positive("Radius"), inner = input.not_negative("Inner radius");
            if (inner >= radius)
              input.reject("Inner radius", "a number below the radius");
            return revolve(input, flat_profile(inner, radius, inner == 0.), input.vector("Centre"),
                           input.direction("Normal"));
          }};
}

} // namespace billet
