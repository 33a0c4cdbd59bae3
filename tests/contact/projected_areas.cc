// SPDX-License-Identifier: LGPL-2.1-or-later
// Shares of a facet's corners as seen along the tool's normals: a quarter each of a parallelogram, none of
// corners that are open or of a facet that looks away, and derivatives against differences.
#include "billet/contact/projected_areas.h"

#include "../testing.h"

namespace projected_areas_test {

using namespace billet;
using billet::testing::central_difference;
using billet::testing::check;
using billet::testing::WorstError;
using dealii::Tensor;

namespace {

using Corners = std::array<ToolContactState, 4>;

CornerStates pointers_to(const Corners &corners) {
  return {&corners[0], &corners[1], &corners[2], &corners[3]};
}

/// A facet that looks down onto a tool whose normal points up; `disorder` bends both.
Corners make_facet(billet::testing::Random &random, const double disorder) {
  Corners corners;
  for (unsigned int a = 0; a < 4; ++a) {
    // ξ along y and η along x, so that the area vector points down
    corners[a].position = Tensor<1, 3>({a >= 2 ? 2. : 0., a % 2 == 1 ? 1.5 : 0., 0.});
    corners[a].normal = Tensor<1, 3>({0., 0., 1.});
    for (unsigned int i = 0; i < 3; ++i) {
      corners[a].position[i] += disorder * random(-1., 1.);
      corners[a].normal[i] += disorder * random(-1., 1.);
    }
    corners[a].normal /= corners[a].normal.norm();
    corners[a].status = ContactStatus::slip;
  }
  return corners;
}

} // namespace

BILLET_TEST(projected_areas) {
  billet::testing::Random random;
  Corners flat = make_facet(random, 0.);
  WorstError quarter;
  for (const double area : compute_projected_areas(pointers_to(flat), false).areas)
    quarter.add(std::abs(area - 0.75));
  check("a quarter of a rectangle each", quarter.value(), 1e-14);
  check("one touches", any_touches(pointers_to(flat)));
  flat[1].status = ContactStatus::open;
  check("none for a corner that is open", compute_projected_areas(pointers_to(flat), true).areas[1] == 0.);
  for (auto &corner : flat)
    corner.normal *= -1.;
  WorstError behind;
  for (const double area : compute_projected_areas(pointers_to(flat), false).areas)
    behind.add(std::abs(area));
  check("none where the facet looks away", behind.value(), 0.);
  for (auto &corner : flat)
    corner.status = ContactStatus::open;
  check("none touches", !any_touches(pointers_to(flat)));

  WorstError of_positions, of_normals;
  for (unsigned int sample = 0; sample < 50; ++sample) {
    const Corners corners = make_facet(random, 0.2);
    const ProjectedAreas found = compute_projected_areas(pointers_to(corners), true);
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int i = 0; i < 3; ++i) {
        const auto difference = [&](const unsigned int b, Tensor<1, 3> ToolContactState::*vector) {
          return central_difference(
              [&](const double h) {
                Corners moved = corners;
                (moved[b].*vector)[i] += h;
                return compute_projected_areas(pointers_to(moved), false).areas[a];
              },
              1e-4);
        };
        for (unsigned int b = 0; b < 4; ++b)
          of_positions.add(std::abs(difference(b, &ToolContactState::position) - found.derivatives[a][b][i]));
        of_normals.add(std::abs(difference(a, &ToolContactState::normal) - found.normal_derivatives[a][i]));
      }
  }
  check("derivatives over positions", of_positions.value(), 1e-10);
  check("derivatives over normals", of_normals.value(), 1e-10);
}

} // namespace projected_areas_test
