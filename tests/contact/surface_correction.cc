// SPDX-License-Identifier: LGPL-2.1-or-later
// Facets against the surface that a scene names for them: of a cylinder, a cone, a barrel and a sphere they
// do not tilt; if the axis is off by d, the largest tilt around a cylinder of radius R is d/R.
#include "billet/contact/surface_correction.h"
#include "billet/contact/faceted_curvature.h"

#include "../testing.h"

#include <cmath>

namespace surface_correction_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;
using Correction = parameters::ContactPair::Correction;

namespace {

constexpr unsigned int n_around = 48;
constexpr double pi = 3.14159265358979323846;

/// Of a surface about the axis through `at` along z; radii at z = 0 and z = 1.
BoundaryFacet facet(const unsigned int i, const Tensor<1, 3> &at, const double low, const double high) {
  BoundaryFacet result{};
  for (unsigned int a = 0; a < 4; ++a) {
    const double angle = 2. * pi * (i + a % 2) / n_around, radius = a < 2 ? low : high;
    result.corners[a] = dealii::Point<3>(at[0] + radius * std::cos(angle), at[1] + radius * std::sin(angle),
                                         at[2] + (a < 2 ? 0. : 1.));
  }
  return result;
}

double max_tilt_around(const Correction &correction, const Tensor<1, 3> &at, const double low,
                       const double high) {
  double maximum = 0.;
  for (unsigned int i = 0; i < n_around; ++i)
    maximum = std::max(maximum, tilt_of(facet(i, at, low, high), correction));
  return maximum;
}

} // namespace

BILLET_TEST(surface_correction) {
  const Tensor<1, 3> at({1., 2., 3.}), z({0., 0., 1.});
  const Correction axis{Correction::Kind::cylinder, at, z};
  check("cylinder", max_tilt_around(axis, at, 5., 5.), 1e-12);
  check("cone", max_tilt_around(axis, at, 5., 4.), 1e-12);
  for (const double off : {0.1, 0.5, 1.}) {
    const Tensor<1, 3> other = at + off * Tensor<1, 3>({0.6, 0.8, 0.});
    // The middles of facets lie nearer to the axis than R, and in finitely many places.
    check("axis beside, by d/R", std::abs(max_tilt_around(axis, other, 5., 5.) / (off / 5.) - 1.), 0.01);
  }
  const Correction centre{Correction::Kind::sphere, at + Tensor<1, 3>({0., 0., 0.5}), {}};
  const double radius = std::hypot(5., 0.5);
  check("sphere", max_tilt_around(centre, at, 5., 5.), 1e-12);
  const Correction below{Correction::Kind::sphere, at, {}};
  check("centre below", std::abs(max_tilt_around(below, at, 5., 5.) / (0.5 / radius) - 1.), 0.01);
}

} // namespace surface_correction_test
