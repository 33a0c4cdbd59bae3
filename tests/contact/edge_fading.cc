// SPDX-License-Identifier: LGPL-2.1-or-later
// Pressure that fades beyond the edge of a tool: forces against differences of the energy s(d) e(−g) beside a
// straight edge, around the corner of one, and outside a disc; tangents against differences of forces.
#include "billet/contact/edge_fading.h"

#include "../testing.h"

#include <string>

namespace edge_fading_test {

using namespace billet;
using billet::testing::central_difference;
using billet::testing::check;
using billet::testing::WorstError;
using dealii::Tensor;

namespace {

constexpr double width = 0.05;
const dealii::SymmetricTensor<2, 3> identity = dealii::unit_symmetric_tensor<3>();

/// The surface z = 0, which ends at x = 0.
RigidSurface::EdgePoint beside_straight_edge(const Tensor<1, 3> &x) {
  RigidSurface::EdgePoint edge_point{};
  edge_point.normal[2] = 1.;
  edge_point.gap = x[2];
  edge_point.beyond = x[0];
  edge_point.outward[0] = 1.;
  return edge_point;
}

/// The surface z = 0, which ends `radius` away from the z axis; 0: at a corner on it.
RigidSurface::EdgePoint beside_round_edge(const Tensor<1, 3> &x, const double radius) {
  RigidSurface::EdgePoint edge_point{};
  edge_point.normal[2] = 1.;
  edge_point.gap = x[2];
  const Tensor<1, 3> across({x[0], x[1], 0.});
  edge_point.beyond = across.norm() - radius;
  edge_point.outward = across / across.norm();
  const Tensor<2, 3> plane = identity - dealii::outer_product(edge_point.normal, edge_point.normal);
  edge_point.spreading =
      1. / across.norm() * (plane - dealii::outer_product(edge_point.outward, edge_point.outward));
  return edge_point;
}

template <class EdgeAt>
void check_edge(const std::string &name, const HardeningSpring &spring, const double radius,
                const EdgeAt &edge_at) {
  const auto fade = [&](const Tensor<1, 3> &x) {
    const RigidSurface::EdgePoint edge_point = edge_at(x);
    return compute_edge_fading(edge_point, width, spring, edge_point.gap);
  };
  const auto energy = [&](const Tensor<1, 3> &x) { return fade(x).share * spring.energy(-edge_at(x).gap); };
  const auto pressure = [&](const Tensor<1, 3> &x) {
    return fade(x).share * spring.pressure(-edge_at(x).gap);
  };
  const auto force = [&](const Tensor<1, 3> &x) { return fade(x).push + pressure(x) * edge_at(x).normal; };
  billet::testing::Random random;
  WorstError of_force, of_slope, of_tangent;
  bool is_bounded = true;
  for (unsigned int sample = 0; sample < 200; ++sample) {
    const double beyond = random(0.1 * width, 0.9 * width), angle = random(-0.5, 0.5);
    const Tensor<1, 3> x(
        {(radius + beyond) * std::cos(angle), (radius + beyond) * std::sin(angle), random(-0.02, -1e-3)});
    if (!(edge_at(x).beyond > 0.05 * width && edge_at(x).beyond < 0.95 * width))
      continue;
    const EdgeFading fading = fade(x);
    const double scale = spring.pressure(-x[2]), stiffness = spring.slope(-x[2]);
    const Tensor<1, 3> n = edge_at(x).normal;
    Tensor<2, 3> added = fading.tangent; // and what p changes by at a fixed s
    added += fading.share * stiffness * dealii::outer_product(n, n);
    is_bounded = is_bounded && fading.tangent.norm() <= fading.stiffness;
    for (unsigned int j = 0; j < 3; ++j) {
      const auto moved = [&](const double h) {
        Tensor<1, 3> y = x;
        y[j] += h;
        return y;
      };
      of_force.add(
          std::abs(central_difference([&](const double h) { return energy(moved(h)); }, 1e-6) + force(x)[j]) /
          scale);
      const double share_slope =
          central_difference([&](const double h) { return fade(moved(h)).share; }, 1e-6);
      of_slope.add(std::abs(share_slope * scale - fading.pressure_slope[j]) / (scale / width));
      for (unsigned int i = 0; i < 3; ++i)
        of_tangent.add(std::abs(central_difference([&](const double h) { return force(moved(h))[i]; }, 1e-6) +
                                added[i][j]) /
                       stiffness);
    }
  }
  check(name + ": the force is what the energy falls by", of_force.value(), 1e-6);
  check(name + ": slope of the pressure", of_slope.value(), 1e-6);
  check(name + ": the tangent is the derivative of the force", of_tangent.value(), 1e-6);
  check(name + ": the bound of the tangent holds", is_bounded);
}

} // namespace

BILLET_TEST(edge_fading) {
  const HardeningSpring linear{1e4}, hardening{1e4, 0.01};
  for (const auto &[name, spring] : {std::pair("linear", linear), std::pair("hardening", hardening)}) {
    const std::string prefix = std::string(name) + " spring, ";
    check_edge(prefix + "straight edge", spring, 0., beside_straight_edge);
    check_edge(prefix + "corner", spring, 0., [](const Tensor<1, 3> &x) { return beside_round_edge(x, 0.); });
    check_edge(prefix + "disc", spring, 0.3, [](const Tensor<1, 3> &x) { return beside_round_edge(x, 0.3); });
  }
}

} // namespace edge_fading_test
