// SPDX-License-Identifier: LGPL-2.1-or-later
// How surfaces end beside a point beyond their border, against closed forms: of a rectangle's side and
// corner, of a disc, and of a cylinder's end.
#include "make_surface.h"

#include "../testing.h"

namespace border_test {

using namespace billet;
using billet::testing::check;
using billet::testing::make_surface;
using billet::testing::WorstError;
using dealii::Tensor;

namespace {

constexpr double width = 0.05; // beyond a border, as of facets of size 1

struct Expected {
  double gap, beyond, spreading, turning;
  Tensor<1, 3> normal, outward;
};

template <class Expect>
void check_edge(const std::string &name, const RigidSurface &surface, const Expect &expect) {
  billet::testing::Random random;
  WorstError gap, beyond, directions, spreading, turning;
  bool is_beyond = true, knows_side = true;
  for (unsigned int i = 0; i < 200; ++i) {
    const double u = random(-0.4, 0.4), d = random(0.001, 0.1), g = random(-0.2, 0.2);
    Tensor<1, 3> x;
    const Expected expected = expect(u, d, g, x);
    const auto projection = surface.project(x);
    is_beyond = is_beyond && !projection.exists;
    knows_side = knows_side && projection.is_behind == (g < 0.);
    const auto edge_point = surface.edge_point(x, projection.patch, width);
    gap.add(std::abs(edge_point.gap - expected.gap));
    beyond.add(std::abs(edge_point.beyond - expected.beyond) + std::abs(projection.beyond - expected.beyond));
    directions.add((edge_point.normal - expected.normal).norm() +
                   (edge_point.outward - expected.outward).norm());
    const Tensor<1, 3> along = dealii::cross_product_3d(expected.normal, expected.outward);
    const Tensor<2, 3> twice = dealii::outer_product(along, along);
    spreading.add((edge_point.spreading - expected.spreading * twice).norm() / (1. + expected.spreading));
    turning.add((edge_point.turning - expected.turning * twice).norm());
  }
  check(name + ": the surface does not lie before the points", is_beyond);
  check(name + ": which side they are on", knows_side);
  check(name + ": gap", gap.value(), 1e-14);
  check(name + ": how far beyond", beyond.value(), 1e-14);
  check(name + ": directions", directions.value(), 1e-11);
  check(name + ": how the way out spreads", spreading.value(), 1e-6);
  check(name + ": how the normal turns", turning.value(), 1e-6);
}

/// However near x is to the border, d ∂²d/∂x² is known; where coordinates are large, round-off is.
void check_near_edge() {
  const auto disc = make_surface("disc", "set Centre = 100, 0, 0\nset Radius = 1");
  WorstError error;
  for (int k = 2; k <= 9; ++k) {
    const double d = std::pow(10., -k), angle = 0.3 * k;
    const Tensor<1, 3> e({std::cos(angle), std::sin(angle), 0.}),
        along({-std::sin(angle), std::cos(angle), 0.}), centre({100., 0., 0.}), below({0., 0., -1e-3});
    const auto edge_point = disc->edge_point(centre + (1. + d) * e + below, 0, width);
    error.add((edge_point.beyond * edge_point.spreading - d / (1. + d) * dealii::outer_product(along, along))
                  .norm());
  }
  check("disc: next to its border", error.value(), 1e-6);
}

} // namespace

BILLET_TEST(border) {
  const Tensor<1, 3> up({0., 0., 1.});
  const auto rectangle = make_surface("rectangle", "set Length = 2\nset Width = 1");
  check_edge("side of a rectangle", *rectangle, [&](const double u, const double d, const double g, auto &x) {
    x = Tensor<1, 3>({1. + d, u, g});
    return Expected{g, d, 0., 0., up, Tensor<1, 3>({1., 0., 0.})};
  });
  check_edge("corner of a rectangle", *rectangle,
             [&](const double u, const double d, const double g, auto &x) {
               const double angle = 0.8 + u;
               const Tensor<1, 3> e({std::cos(angle), std::sin(angle), 0.});
               x = Tensor<1, 3>({1., 0.5, g}) + d * e;
               return Expected{g, d, 1. / d, 0., up, e};
             });
  constexpr double radius = 0.7;
  check_edge("disc", *make_surface("disc", "set Radius = 0.7"),
             [&](const double u, const double d, const double g, auto &x) {
               const Tensor<1, 3> e({std::cos(5. * u), std::sin(5. * u), 0.});
               x = (radius + d) * e + g * up;
               return Expected{g, d, 1. / (radius + d), 0., up, e};
             });
  check_edge("end of a cylinder",
             *make_surface("cylinder", "set Radius = 0.7\nset Length = 3\nset Axis = 0, 0, 1"),
             [&](const double u, const double d, const double g, auto &x) {
               const Tensor<1, 3> n({std::cos(5. * u), std::sin(5. * u), 0.});
               x = (radius + g) * n + (1.5 + d) * up;
               return Expected{g, d, 0., 1. / (radius + g), n, up};
             });
  check_near_edge();
}

} // namespace border_test
