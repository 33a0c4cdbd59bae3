// SPDX-License-Identifier: LGPL-2.1-or-later
// Profiles swept along a rounded rectangle: a point projects onto the profile in the plane across the nearest
// point of the path, whose distance has a closed form. A box punch, its die and a binder frame.
#include "make_surface.h"

#include "../testing.h"

namespace swept_test {

using namespace billet;
using billet::testing::check;
using billet::testing::WorstError;
using dealii::Tensor;

namespace {

constexpr double half_x = 6., half_y = 4., radius = 1.5;

const std::string path = "set Path lengths = 12, 8\nset Corner radius = 1.5\n";

/// Distance outwards from the path.
double outside_path(const Tensor<1, 3> &x) {
  const double a = std::abs(x[0]) - (half_x - radius), b = std::abs(x[1]) - (half_y - radius);
  return std::hypot(std::max(a, 0.), std::max(b, 0.)) + std::min(std::max(a, b), 0.) - radius;
}

/// Gap of a point (distance from the path, height) outside a punch: wall at 0, bottom at 0, fillet of 1.
double punch_gap(const double distance, const double height) {
  const double a = distance + 1., b = 1. - height; // from the middle of the fillet
  if (a > 0. && b > 0.)
    return std::hypot(a, b) - 1.;
  return std::max(a, b) - 1.;
}

/// The same of a die: a hole with wall at 0, top at 0, fillet of 1.
double die_gap(const double distance, const double height) {
  const double a = 1. - distance, b = height + 1.;
  if (a > 0. && b > 0.)
    return std::hypot(a, b) - 1.;
  return std::max(a, b) - 1.;
}

/// Largest error of gaps and of their derivatives, the normals, at random points.
template <class Gap> void test(const std::string &name, const std::string &lines, const Gap &gap) {
  const auto surface = testing::make_surface("swept profile", path + lines);
  testing::Random random;
  WorstError gap_error, normal_error;
  for (unsigned int i = 0; i < 4000; ++i) {
    const Tensor<1, 3> x({random(-8., 8.), random(-6., 6.), random(-3., 3.)});
    const double expected = gap(x);
    if (std::isnan(expected))
      continue;
    const auto projection = surface->project(x);
    if (!projection.exists) {
      gap_error.add(1.);
      continue;
    }
    gap_error.add(std::abs(projection.gap - expected));
    const double h = 1e-4;
    Tensor<1, 3> slope;
    for (unsigned int j = 0; j < 3; ++j) {
      Tensor<1, 3> step;
      step[j] = h;
      const double next = gap(x + step), last = gap(x - step);
      slope[j] = (next - last) / (2. * h);
    }
    if (std::abs(slope.norm() - 1.) < 1e-6) // not across an edge
      normal_error.add((projection.normal - slope).norm());
  }
  check(name + ": gaps", gap_error.value(), 1e-10);
  check(name + ": normals", normal_error.value(), 1e-5);
}

} // namespace

BILLET_TEST(swept) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  // Above the bottom, inside, no point is of interest: another wall or the bottom may be nearer.
  test("punch", "set Corners = 0, 0 : 1 ; 0, 5\nset Outside = right\nset Inside = flat", [=](const auto &x) {
    const double distance = outside_path(x);
    return x[2] < 0.9 || distance > -0.9
               ? (distance < -0.9 && x[2] > 0.5 ? nothing : punch_gap(distance, x[2]))
               : nothing;
  });
  test("die", "set Corners = 0, -5 ; 0, 0 : 1 ; 9, 0\nset Outside = left", [=](const auto &x) {
    const double distance = outside_path(x);
    // within a corner radius of the path, where one wall is nearest
    return distance > -1.4 && distance < 8. && (x[2] > -0.9 || distance < 0.9) ? die_gap(distance, x[2])
                                                                               : nothing;
  });
  test("binder", "set Corners = 0.5, 0 ; 9, 0\nset Outside = right", [=](const auto &x) {
    const double distance = outside_path(x);
    return distance > 0.51 && distance < 8. ? -x[2] : nothing;
  });
  const auto binder =
      testing::make_surface("swept profile", path + "set Corners = 0.5, 0 ; 9, 0\nset Outside = right");
  check("the binder has a hole", !binder->project(Tensor<1, 3>({6.4, 0., -0.1})).exists &&
                                     binder->project(Tensor<1, 3>({6.6, 0., -0.1})).exists);
  const auto box = binder->bounding_box();
  check("the box contains it", box.low[0] <= -15. && box.high[1] >= 13.);
  // Pictures: chords near their arcs, at a bounded number of facets.
  const auto roll =
      testing::make_surface("cylinder", "set Point = 0, 0, 0\nset Axis = 0, 1, 0\nset Radius = 3");
  const SurfaceMesh drawn = roll->surface_mesh({Tensor<1, 3>(), 1.});
  double sagitta = 0.;
  for (const auto &facet : drawn.facets) {
    Tensor<1, 3> middle;
    for (const unsigned int corner : facet)
      middle += drawn.points[corner] / static_cast<double>(facet.size());
    sagitta = std::max(sagitta, std::abs(roll->project(middle).gap) / 3.);
  }
  check("chords of a cylinder", sagitta > 0. && sagitta < 2e-4);
  const auto ring = testing::make_surface(
      "torus", "set Centre = 0, 0, 0\nset Axis = 0, 0, 1\nset Ring radius = 3\nset Tube radius = 1");
  check("facets of a torus", ring->surface_mesh({Tensor<1, 3>(), 4.}).facets.size() <= 10000);
}

} // namespace swept_test
