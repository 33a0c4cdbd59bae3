// SPDX-License-Identifier: LGPL-2.1-or-later
// Facets of four nodes as planes through their means and as bilinear surfaces: gaps, normals, weights, the
// inside test, what is left of both when corners meet, and the closest points of segments.
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/planed_facet.h"
#include "billet/geometry/segment_pair.h"

#include "facet_samples.h"

#include <string>
#include <vector>

namespace facets_test {

using namespace billet;
using billet::testing::check;
using billet::testing::Random;
using billet::testing::random_facet;
using billet::testing::random_vector;
using billet::testing::WorstError;
using dealii::Tensor;

namespace {

Tensor<1, 3> vector(const double x, const double y, const double z) { return Tensor<1, 3>({x, y, z}); }

FacetCorners unit_square() { // ξ = x, η = y
  return {vector(-1., -1., 0.), vector(1., -1., 0.), vector(-1., 1., 0.), vector(1., 1., 0.)};
}

Tensor<1, 3> mean(const FacetCorners &x) { return 0.25 * (x[0] + x[1] + x[2] + x[3]); }

/// A point above or below the middle part of the facet.
Tensor<1, 3> point_near(Random &random, const FacetCorners &x, const double parameters, const double height) {
  const Tensor<1, 3> area_vector = dealii::cross_product_3d(x[3] - x[0], x[2] - x[1]);
  return facet::interpolate(
             facet::weights({random(-parameters, parameters), random(-parameters, parameters)}), x) +
         random(-height, height) / std::sqrt(area_vector.norm()) * area_vector;
}

template <class Facet> void check_any_facet(const std::string &name) {
  Random random;
  WorstError sum, across, gap, moved, scaled;
  unsigned int n_missed = 0, n_outside = 0;
  for (unsigned int i = 0; i < 3000; ++i) {
    const double size = std::pow(10., random(-6., 6.));
    const FacetCorners corners = random_facet(random, size, 0.2);
    const Tensor<1, 3> x = point_near(random, corners, 0.8, 0.1);
    const FacetLimits limits{0.02};
    const FacetProjection p = Facet(corners).project(x, limits);
    n_missed += p.exists ? 0 : 1;
    sum.add(std::abs(p.weights[0] + p.weights[1] + p.weights[2] + p.weights[3] - 1.));
    const Tensor<1, 3> arm = x - facet::interpolate(p.weights, corners);
    across.add((arm - (arm * p.normal) * p.normal).norm() / size);
    gap.add(std::abs(p.normal.norm() - 1.));

    // The same facet and node elsewhere, and in another unit of length.
    const Tensor<2, 3> R = random.rotation();
    const Tensor<1, 3> shift = random_vector(random, size);
    FacetCorners rotated, larger;
    for (unsigned int a = 0; a < 4; ++a) {
      rotated[a] = R * corners[a] + shift;
      larger[a] = 1024. * corners[a];
    }
    const FacetProjection q = Facet(rotated).project(R * x + shift, limits, p.parameters);
    moved.add(std::abs(q.gap - p.gap) / size);
    moved.add((q.normal - R * p.normal).norm());
    const FacetProjection s = Facet(larger).project(1024. * x, limits);
    for (unsigned int a = 0; a < 4; ++a) {
      moved.add(std::abs(q.weights[a] - p.weights[a]));
      scaled.add(std::abs(s.weights[a] - p.weights[a]));
    }
    scaled.add(std::abs(s.gap - 1024. * p.gap) / size);

    // Beside the facet there is nothing.
    const Tensor<1, 3> beside = corners[3] + (corners[3] - corners[0]);
    n_outside += Facet(corners).project(beside, limits).exists ? 1 : 0;
  }
  check(name + ": nodes before a facet and behind it are found", n_missed == 0);
  check(name + ": nodes beside a facet are not", n_outside == 0);
  check(name + ": the normal is a unit vector", gap.value(), 1e-15);
  check(name + ": weights sum to one", sum.value(), 1e-15);
  check(name + ": the node is straight above its weights", across.value(), 1e-14);
  check(name + ": goes along with a rigid motion", moved.value(), 1e-12);
  check(name + ": knows no unit of length", scaled.value(), 1e-14);
}

template <class Facet> void check_flat_square(const std::string &name) {
  WorstError error;
  Random random;
  const Facet facet(unit_square());
  for (unsigned int i = 0; i < 1000; ++i) {
    const std::array<double, 2> at{random(-1., 1.), random(-1., 1.)};
    const double height = random(-0.5, 0.5);
    const FacetProjection p = facet.project(vector(at[0], at[1], height), {});
    error.add(std::abs(p.gap - height));
    error.add((p.normal - vector(0., 0., 1.)).norm());
    for (unsigned int a = 0; a < 4; ++a)
      error.add(std::abs(p.weights[a] - facet::weights(at)[a]));
    error.add(p.excess);
  }
  check(name + ": a square in its plane", error.value(), 1e-15);
  // (20) with a tolerance: 1 % of the width of 2 on each side.
  const FacetLimits limits{0.01};
  const auto exists = [&](const double x) { return facet.project(vector(x, 0.3, -0.1), limits).exists; };
  const double range = 1.02;
  check(name + ": the tolerance at the border",
        exists(0.999 * range) && exists(-0.999 * range) && !exists(1.001 * range) && !exists(-1.001 * range));
}

/// Below the tip of a triangle, whose two corners coincide, both bear half of the force.
template <class Facet> void check_tip(const std::string &name, const bool has_round_off) {
  Random random;
  WorstError error;
  unsigned int n_lost = 0;
  for (unsigned int i = 0; i < 200; ++i)
    for (const unsigned int twin : {1, 2}) {
      FacetCorners triangle = unit_square();
      triangle[twin] = triangle[0];
      if (has_round_off)
        for (Tensor<1, 3> &corner : triangle)
          corner *= random(0.1, 3.);
      triangle[0] = triangle[twin];
      const FacetProjection p = Facet(triangle).project(triangle[0] + vector(0., 0., -0.1), {});
      n_lost += p.exists ? 0 : 1;
      error.add(std::abs(p.weights[0] - 0.5));
      error.add(std::abs(p.weights[twin] - 0.5));
      error.add((p.normal - vector(0., 0., 1.)).norm());
    }
  check(name + ": below the tip of a triangle", n_lost == 0);
  check(name + ": the tip's corners bear half of the force each", error.value(), 1e-7);
}

template <class Facet> void check_degenerate(const std::string &name) {
  FacetCorners triangle = unit_square();
  triangle[1] = triangle[0];
  WorstError error;
  Random random;
  unsigned int n_wrong = 0;
  for (unsigned int i = 0; i < 2000; ++i) {
    // Barycentric, some of them outside.
    const double s = random(-0.2, 1.2), t = random(-0.2, 1.2);
    const Tensor<1, 3> foot = (1. - s - t) * triangle[0] + s * triangle[2] + t * triangle[3];
    const FacetProjection p = Facet(triangle).project(foot + vector(0., 0., -0.1), {0.});
    const bool is_inside = std::min({s, t, 1. - s - t}) > 0.;
    n_wrong += p.exists == is_inside ? 0 : 1;
    if (!is_inside)
      continue;
    error.add(std::abs(p.gap + 0.1));
    error.add((p.normal - vector(0., 0., 1.)).norm());
    error.add((facet::interpolate(p.weights, triangle) - foot).norm());
  }
  check(name + ": two corners in one place are a triangle", n_wrong == 0);
  check(name + ": its gap, normal and weights", error.value(), 1e-13);
  const Tensor<1, 3> beyond = triangle[0] - vector(0.3, 0.3, 0.1);
  const FacetProjection tip = Facet(triangle).project(beyond, {1.});
  check(name + ": beyond its tip", !Facet(triangle).project(beyond, {}).exists && std::isfinite(tip.gap) &&
                                       std::isfinite(tip.weights[0]) && std::isfinite(tip.parameters[0]));

  const Tensor<1, 3> a = vector(0.1, 0.7, 0.3), d = vector(0.3, -0.2, 0.9);
  const std::vector<FacetCorners> none{
      {a, a, a, a},
      {a, a, d, d},
      {a, a + 0.3 * d, a + 0.7 * d, a + d},
      {a, a, a, a + d},
      {a, a + vector(1., 0., 0.), a + vector(1., 1., 0.), a + vector(0., 1., 0.)}};
  bool is_none = true;
  for (const auto &corners : none)
    is_none = is_none && !Facet(corners).project(mean(corners) + vector(0., 0., 1e-3), {}).exists;
  check(name + ": facets without area have no projection", is_none);

  FacetCorners slender = unit_square();
  for (auto &x : slender)
    x[1] *= 1e-5;
  const FacetProjection p = Facet(slender).project(vector(0.5, 0.5e-5, -1e-6), {});
  check(name + ": a slender facet", p.exists ? std::abs(p.gap + 1e-6) + std::abs(p.parameters[1] - 0.5) : 1.,
        1e-10);
}

void check_planed() {
  // (16)-(18) as they are printed.
  Random random;
  WorstError normal, gap;
  for (unsigned int i = 0; i < 1000; ++i) {
    const FacetCorners x = random_facet(random, 1., 0.3);
    const Tensor<1, 3> at = point_near(random, x, 0.5, 0.2);
    Tensor<1, 3> sum;
    for (unsigned int k = 0; k < 4; ++k) {
      const auto &x_I = x[facet::around[k]];
      sum +=
          dealii::cross_product_3d(x[facet::around[(k + 1) % 4]] - x_I, x[facet::around[(k + 3) % 4]] - x_I);
    }
    const FacetProjection p = MeanGapFacet(x).project(at, {});
    normal.add((p.normal - sum / sum.norm()).norm());
    double mean_gap = 0.;
    for (unsigned int a = 0; a < 4; ++a)
      mean_gap += 0.25 * ((at - x[a]) * sum) / sum.norm();
    gap.add(std::abs(p.gap - mean_gap));
  }
  check("planed: eq. (18)", normal.value(), 1e-15);
  check("planed: eqs. (16), (17)", gap.value(), 1e-14);

  // The inside test is (20), of corners in the plane.
  unsigned int n_wrong = 0, n_inside = 0;
  for (unsigned int i = 0; i < 3000; ++i) {
    const FacetCorners x = random_facet(random, 1., 0.);
    const Tensor<1, 3> v = point_near(random, x, 1.5, 0.);
    bool is_inside = true;
    for (unsigned int k = 0; k < 4; ++k) {
      const auto &x_I = x[facet::around[k]];
      const Tensor<1, 3> m = x[facet::around[(k + 1) % 4]] - x_I, p = x[facet::around[(k + 3) % 4]] - x_I;
      const Tensor<1, 3> mp = dealii::cross_product_3d(m, p), mv = dealii::cross_product_3d(m, v - x_I),
                         vp = dealii::cross_product_3d(v - x_I, p);
      is_inside = is_inside && mv * mp >= 0. && mv * vp >= 0.;
    }
    n_inside += is_inside ? 1 : 0;
    n_wrong += is_inside == PlanedFacet(x).project(v, {0.}).exists ? 0 : 1;
  }
  check("planed: eq. (20)", n_wrong == 0 && n_inside > 500 && n_inside < 2500);

  // Of plane facets the gap's gradients are the reaction's weights, (C1); the mean gap's are not, by ±ξη/4.
  WorstError gradient, mean_gradient;
  for (unsigned int i = 0; i < 1000; ++i) {
    FacetCorners x = unit_square();
    for (auto &corner : x)
      corner[2] = 0.;
    const Tensor<1, 3> at = vector(random(0.05, 0.95), random(0.05, 0.95), random(-0.1, 0.1));
    const FacetProjection p = PlanedFacet(x).project(at, {});
    const double step = 1e-6, both = p.parameters[0] * p.parameters[1];
    for (unsigned int a = 0; a < 4; ++a) {
      std::array<double, 2> gaps{}, mean_gaps{};
      for (unsigned int side = 0; side < 2; ++side) {
        FacetCorners moved = x;
        moved[a] += (side == 0 ? -step : step) * p.normal;
        gaps[side] = PlanedFacet(moved).project(at, {}).gap;
        mean_gaps[side] = MeanGapFacet(moved).project(at, {}).gap;
      }
      gradient.add(std::abs((gaps[1] - gaps[0]) / (2. * step) + p.weights[a]));
      const double sign = facet::signs[a][0] * facet::signs[a][1];
      mean_gradient.add(
          std::abs((mean_gaps[1] - mean_gaps[0]) / (2. * step) + p.weights[a] - 0.25 * sign * both));
    }
  }
  check("planed: the gap's gradients are the weights", gradient.value(), 1e-9);
  check("planed: those of the mean gap lack the warping", mean_gradient.value(), 1e-9);

  // Outside of the facet, and where its corners make no convex quadrilateral, weights still balance moments.
  WorstError across;
  for (unsigned int i = 0; i < 3000; ++i) {
    FacetCorners x = random_facet(random, 1., 0.3);
    if (i % 3 == 1)
      x[0] += 0.7 * (x[3] - x[0]); // an arrow
    if (i % 3 == 2)
      x[1] = x[0];
    const Tensor<1, 3> at = point_near(random, x, 2., 0.3);
    const FacetProjection p = PlanedFacet(x).project(at, {100.});
    const Tensor<1, 3> arm = at - facet::interpolate(p.weights, x);
    across.add((arm - p.gap * p.normal).norm());
  }
  check("planed: the gap is that to the weights' point, straight above it anywhere", across.value(), 1e-13);
}

void check_bilinear() {
  Random random;
  WorstError closer, gradient;
  for (unsigned int i = 0; i < 300; ++i) {
    const FacetCorners x = random_facet(random, 1., 0.8);
    const Tensor<1, 3> at = point_near(random, x, 1.5, 0.3);
    const FacetProjection p = BilinearFacet(x).project(at, {0.});
    // No point of a grid over the facet is nearer.
    const double distance = (at - facet::interpolate(p.weights, x)).norm();
    constexpr int n = 50;
    for (int k = -n; k <= n; ++k)
      for (int l = -n; l <= n; ++l)
        closer.add(distance -
                   (at - facet::interpolate(
                             facet::weights({k / static_cast<double>(n), l / static_cast<double>(n)}), x))
                       .norm());
    if (!p.exists)
      continue;
    // ∂g/∂x = n, ∂g/∂x_I = −w_I n
    const Tensor<1, 3> direction = random_vector(random, 1.);
    for (unsigned int a = 0; a < 5; ++a) {
      const auto gap = [&](const double h) {
        FacetCorners moved = x;
        Tensor<1, 3> node = at;
        (a == 4 ? node : moved[a]) += h * direction;
        return BilinearFacet(moved).project(node, {0.1}, p.parameters).gap;
      };
      const double expected = (a == 4 ? 1. : -p.weights[a]) * (p.normal * direction);
      gradient.add(std::abs(billet::testing::central_difference(gap, 1e-3) - expected));
    }
  }
  check("bilinear: no point of the facet is nearer", std::max(0., closer.value()), 1e-14);
  check("bilinear: the gap's gradient", gradient.value(), 1e-6);
}

void check_segments() {
  Random random;
  WorstError closer, consistent;
  unsigned int n_crossing = 0;
  for (unsigned int i = 0; i < 3000; ++i) {
    Segment first{random_vector(random, 1.), random_vector(random, 1.)},
        second{random_vector(random, 1.), random_vector(random, 1.)};
    if (i % 5 == 1)
      second[1] = second[0] + random(-2., 2.) * (first[1] - first[0]); // parallel
    if (i % 5 == 2)
      second[1] = second[0] + random(-2., 2.) * (first[1] - first[0]) + random_vector(random, 1e-9);
    if (i % 5 == 3)
      second[1] = second[0];
    if (i % 10 == 3)
      first[1] = first[0];
    const SegmentPair pair = closest_points(first, second);
    n_crossing += pair.is_crossing ? 1 : 0;
    const auto at = [](const Segment &s, const double t) { return (1. - t) * s[0] + t * s[1]; };
    consistent.add((at(first, pair.parameters[0]) - at(second, pair.parameters[1]) - pair.difference).norm());
    consistent.add(std::abs(pair.distance - pair.difference.norm()));
    if (pair.is_crossing && i % 5 == 0) {
      consistent.add(std::abs(pair.difference * (first[1] - first[0])));
      consistent.add(std::abs(pair.difference * (second[1] - second[0])));
    }
    constexpr int n = 40;
    for (int k = 0; k <= n; ++k)
      for (int l = 0; l <= n; ++l)
        closer.add(pair.distance -
                   (at(first, k / static_cast<double>(n)) - at(second, l / static_cast<double>(n))).norm());
  }
  check("segments: no points are nearer, parallel and of no length too", std::max(0., closer.value()), 1e-14);
  check("segments: distance and difference", consistent.value(), 1e-12);
  check("segments: some cross", n_crossing > 100);
}

} // namespace

BILLET_TEST(facets) {
  check_flat_square<PlanedFacet>("planed");
  check_flat_square<BilinearFacet>("bilinear");
  check_any_facet<PlanedFacet>("planed");
  check_any_facet<BilinearFacet>("bilinear");
  check_degenerate<PlanedFacet>("planed");
  check_degenerate<BilinearFacet>("bilinear");
  check_tip<PlanedFacet>("planed", true);
  check_tip<BilinearFacet>("bilinear", false);
  check_planed();
  check_bilinear();
  check_segments();
}

} // namespace facets_test
