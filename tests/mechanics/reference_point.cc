// SPDX-License-Identifier: LGPL-2.1-or-later
// Reference coordinates of points in trilinear elements: those of which the point was made.
#include "billet/mechanics/reference_point.h"

#include "../testing.h"

#include <deal.II/base/geometry_info.h>

#include <cmath>

namespace reference_point_test {

using namespace billet;
using billet::testing::check;
using Unit = dealii::GeometryInfo<3>;

namespace {

dealii::Tensor<1, 3> map(const ElementVectors &corners, const dealii::Point<3> &xi) {
  dealii::Tensor<1, 3> x;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int i = 0; i < 3; ++i)
      x[i] += Unit::d_linear_shape_function(xi, a) * corners[3 * a + i];
  return x;
}

} // namespace

BILLET_TEST(reference_point) {
  billet::testing::Random random;
  ElementVectors brick{}, warped{};
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int i = 0; i < 3; ++i) {
      const double edge = Unit::unit_cell_vertex(a)[i];
      brick[3 * a + i] = 5. + 2. * edge;
      warped[3 * a + i] = edge + random(-0.1, 0.1);
    }
  billet::testing::WorstError error;
  bool is_found = true;
  for (unsigned int n = 0; n < 100; ++n) {
    const dealii::Point<3> xi(random(-0.2, 1.2), random(-0.2, 1.2), random(-0.2, 1.2));
    for (const ElementVectors &corners : {brick, warped}) {
      const auto found = find_reference_point(corners, map(corners, xi));
      is_found = is_found && found;
      error.add(found ? (*found - xi).norm() : 1.);
    }
  }
  check("every point in an element and around it is found", is_found);
  check("at its coordinates", error.value(), 1e-12);
  unsigned int n_lost = 0;
  billet::testing::WorstError off;
  for (unsigned int degrees = 1; degrees <= 30; ++degrees) { // prisms of a wedge, points on its axis
    const double angle = M_PI / 180. * degrees;
    ElementVectors prism{};
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const dealii::Point<3> corner = Unit::unit_cell_vertex(a);
      prism[3 * a] = 0.7 * corner[0] * std::cos(corner[2] * angle);
      prism[3 * a + 1] = 0.7 * corner[0] * std::sin(corner[2] * angle);
      prism[3 * a + 2] = -3. + 1.1 * corner[1];
    }
    for (const double height : {-3., -2.7, -1.9}) {
      const dealii::Tensor<1, 3> point({0., 0., height});
      const auto found = find_reference_point(prism, point);
      n_lost += found && Unit::distance_to_unit_cell(*found) < 1e-6 ? 0 : 1;
      off.add(found ? (map(prism, *found) - point).norm() : 1.);
    }
  }
  check("points on the axis of a wedge are in its prisms", n_lost == 0);
  check("at their places", off.value(), 1e-12);
  const dealii::Point<3> away(0.5, 0.5, 4.5);
  check("a point far away is found",
        (find_reference_point(brick, map(brick, away)).value_or(dealii::Point<3>()) - away).norm(), 1e-12);
  check("unless it counts as outside", !find_reference_point(brick, map(brick, away), {15, 3.}) &&
                                           find_reference_point(brick, map(brick, away), {15, 5.}));
  check("one iteration finds a point, and the second sees it",
        !find_reference_point(brick, map(brick, away), {1}) &&
            find_reference_point(brick, map(brick, away), {2}));
  ElementVectors flat = brick;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    flat[3 * a + 2] = 0.;
  check("a flat element has no coordinates", !find_reference_point(flat, map(flat, away)));
  check("nor has an equation that is singular",
        !solve_linear(dealii::Tensor<2, 3>(), dealii::Tensor<1, 3>({1., 0., 0.})));
}

} // namespace reference_point_test
