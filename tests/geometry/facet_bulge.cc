// SPDX-License-Identifier: LGPL-2.1-or-later
// Facets that stand for a curved surface: its heights (C8), (C9), and the gap (C10) between the facets of two
// concentric cylinders, which is the difference of their radii wherever their chords are.
#include "billet/geometry/facet_bulge.h"
#include "billet/geometry/facet_overlap.h"

#include "facet_samples.h"

namespace facet_bulge_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

void check_heights() {
  Random random;
  WorstError corners, middles, slope;
  const FacetBulge bulge{0.1, -0.2, 0.3, 0.4};
  for (const auto &sign : facet::signs)
    corners.add(std::abs(facet::height<double>(bulge, {sign[0], sign[1]})));
  const std::array<std::array<double, 2>, 4> at{{{0., -1.}, {1., 0.}, {0., 1.}, {-1., 0.}}};
  for (unsigned int i = 0; i < 4; ++i) {
    middles.add(std::abs(facet::height<double>(bulge, at[i]) - bulge[i]));
    const Tensor<1, 3> a({facet::signs[facet::around[i]][0], facet::signs[facet::around[i]][1], 0.}),
        b({facet::signs[facet::around[(i + 1) % 4]][0], facet::signs[facet::around[(i + 1) % 4]][1], 0.});
    middles.add((0.5 * (a + b) - Tensor<1, 3>({at[i][0], at[i][1], 0.})).norm());
  }
  for (unsigned int i = 0; i < 100; ++i) {
    const std::array<double, 2> x{random(-1., 1.), random(-1., 1.)}, v{random(-1., 1.), random(-1., 1.)};
    const auto gradient = facet::height_gradient<double>(bulge, x);
    const double difference = central_difference(
        [&](const double s) {
          return facet::height<double>(bulge, {x[0] + s * v[0], x[1] + s * v[1]});
        },
        1e-3);
    slope.add(std::abs(difference - gradient[0] * v[0] - gradient[1] * v[1]));
    corners.add(std::max(0., facet::height<double>(bulge, x) - facet::max_height(bulge)));
  }
  check("0 at the corners, and nowhere above the largest height", corners.value(), 1e-15);
  check("edges in their order", middles.value(), 1e-15);
  check("gradient", slope.value(), 1e-11);
}

/// From `from` to `to` in angle, of a cylinder about z with this radius, seen from outside or inside.
FacetCorners facet_of_cylinder(const double radius, const double from, const double to, const double low,
                               const double high, const bool from_outside) {
  const auto at = [radius](const double angle, const double z) {
    return Tensor<1, 3>({radius * std::cos(angle), radius * std::sin(angle), z});
  };
  const double first = from_outside ? from : to, second = from_outside ? to : from;
  return {at(first, low), at(second, low), at(first, high), at(second, high)};
}

FacetBulge bulge_of(const FacetCorners &corners, const double sign) {
  FacetCorners normals;
  for (unsigned int a = 0; a < 4; ++a) {
    normals[a] = Tensor<1, 3>({corners[a][0], corners[a][1], 0.});
    normals[a] *= sign / normals[a].norm();
  }
  return facet::bulge_from_normals(corners, normals);
}

void check_normals() {
  WorstError error;
  for (const double angle : {0.5, 0.25, 0.1}) {
    const double radius = 3., sagitta = radius * (1. - std::cos(0.5 * angle));
    const FacetBulge convex = bulge_of(facet_of_cylinder(radius, 0., angle, 0., 1., true), 1.),
                     concave = bulge_of(facet_of_cylinder(radius, 0., angle, 0., 1., false), -1.);
    error.add(std::abs(convex[0] / sagitta - 1.) / (angle * angle));
    error.add(std::abs(concave[0] / sagitta + 1.) / (angle * angle));
    error.add(std::abs(convex[1]) + std::abs(concave[1]));
  }
  check("the rise of a chord, to second order", error.value(), 0.1);
}

/// Largest error of the mean gaps between all facets of both, relative to the sagitta of the slave's.
double gap_error(const bool is_corrected) {
  constexpr double radius = 1., overlap = 0.005;
  constexpr unsigned int n_slaves = 13, n_targets = 9;
  const double quarter = dealii::numbers::PI_2, sagitta = radius * (1. - std::cos(0.5 * quarter / n_slaves));
  WorstError worst;
  unsigned int n_found = 0;
  for (unsigned int s = 0; s < n_slaves; ++s)
    for (unsigned int t = 0; t < n_targets; ++t) {
      const FacetCorners slave = facet_of_cylinder(radius + overlap, quarter * s / n_slaves,
                                                   quarter * (s + 1) / n_slaves, 0., 0.15, true),
                         target = facet_of_cylinder(radius, quarter * t / n_targets,
                                                    quarter * (t + 1) / n_targets, -0.05, 0.2, false);
      const auto found = is_corrected ? compute_overlap(slave, target, 0.5, {}, {}, bulge_of(slave, 1.),
                                                        bulge_of(target, -1.))
                                      : compute_overlap(slave, target, 0.5);
      for (unsigned int a = 0; a < 4; ++a)
        if (found.areas[a] > 1e-4) {
          ++n_found;
          worst.add(std::abs(found.gaps[a] / found.areas[a] + overlap) / sagitta);
        }
    }
  check("facets are found", n_found > 4 * n_slaves);
  return worst.value();
}

} // namespace

BILLET_TEST(facet_bulge) {
  check_heights();
  check_normals();
  check("chords miss the gap by more than the slave's rise", gap_error(false) > 1.);
  check("curved facets have it", gap_error(true), 0.2);
}

} // namespace facet_bulge_test
