// SPDX-License-Identifier: LGPL-2.1-or-later
// The plane's projection against its closed form, eq. (13) of Bittencourt & Creus (1998), its picture, and
// the placement of a tool that turns and moves.
#include "billet/geometry/plane.h"
#include "billet/geometry/placement.h"

#include "../testing.h"

namespace plane_test {

using namespace billet;
using billet::testing::check;
using billet::testing::WorstError;
using dealii::Tensor;

BILLET_TEST(plane) {
  billet::testing::Random random;
  WorstError gap_error, normal_error, picture_error, round_trip_error, rigid_error;
  for (unsigned int i = 0; i < 1000; ++i) {
    const Tensor<1, 3> point = random.vector(10.), x = random.vector(10.);
    const Tensor<1, 3> normal = random.rotation() * Tensor<1, 3>({0., 0., 1.});
    const Plane plane(point, normal);
    const auto projection = plane.closest_point(x);
    const Tensor<1, 3> foot = x - projection.gap * projection.normal;
    gap_error.add(std::abs((foot - point) * normal)); // the contact point lies in the plane
    normal_error.add((projection.normal - normal).norm());
    SurfaceMesh surface_mesh;
    plane.draw({x, 3.}, surface_mesh);
    for (const auto &corner : surface_mesh.points)
      picture_error.add(std::abs(plane.closest_point(corner).gap));

    Placement placement;
    placement.rotation = random.rotation();
    placement.centre = point;
    placement.translation = normal;
    round_trip_error.add((placement.to_tool(placement.to_space(x)) - x).norm());
    rigid_error.add((placement.to_space(point) - placement.moved_centre()).norm());
    rigid_error.add(std::abs((placement.to_space(x) - placement.moved_centre()).norm() - (x - point).norm()));
  }
  check("the contact point lies in the plane", gap_error.value(), 1e-13);
  check("the normal is the plane's", normal_error.value(), 0.);
  Tensor<1, 3> above({0., 0., 2.}), below({0., 0., -2.}), up({0., 0., 1.});
  check("the gap is positive outside, negative inside",
        Plane(Tensor<1, 3>(), up).closest_point(above).gap == 2. &&
            Plane(Tensor<1, 3>(), up).closest_point(below).gap == -2.);
  check("the picture lies in the plane", picture_error.value(), 1e-13);
  check("to the tool and back", round_trip_error.value(), 1e-13);
  check("a placement is rigid, and turns about the centre", rigid_error.value(), 1e-13);
}

} // namespace plane_test
