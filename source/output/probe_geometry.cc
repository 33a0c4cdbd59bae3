// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/probe_geometry.h"

#include "billet/mechanics/reference_point.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

struct Limits {
  static constexpr unsigned int iterations = 30;
  /// Last step of Newton's method, in reference coordinates.
  static constexpr double converged = 1e-10;
  static constexpr double diverged = 100.; ///< step of Newton's method, in reference coordinates
  static constexpr double outside = 1e-6;  ///< of the unit square, as round-off
};

std::array<double, 4> shape_functions(const std::array<double, 2> &at) {
  return {(1. - at[0]) * (1. - at[1]), at[0] * (1. - at[1]), (1. - at[0]) * at[1], at[0] * at[1]};
}

std::array<Tensor<1, 3>, 2> tangents(const FacetCorners &c, const std::array<double, 2> &at) {
  return {(1. - at[1]) * (c[1] - c[0]) + at[1] * (c[3] - c[2]),
          (1. - at[0]) * (c[2] - c[0]) + at[0] * (c[3] - c[1])};
}

} // namespace

Tensor<1, 3> point_of_facet(const FacetCorners &corners, const std::array<double, 2> &at) {
  const std::array<double, 4> N = shape_functions(at);
  return N[0] * corners[0] + N[1] * corners[1] + N[2] * corners[2] + N[3] * corners[3];
}

Tensor<1, 3> normal_of_facet(const FacetCorners &corners, const std::array<double, 2> &at) {
  const auto [g_1, g_2] = tangents(corners, at);
  const Tensor<1, 3> area = dealii::cross_product_3d(g_1, g_2);
  const double norm = area.norm();
  if (!(norm > 0.))
    return {};
  return area / norm;
}

bool FacetCrossing::is_on_facet() const {
  return std::all_of(at.begin(), at.end(),
                     [](const double s) { return s >= -Limits::outside && s <= 1. + Limits::outside; });
}

std::optional<FacetCrossing> cross_facet(const FacetCorners &corners, const Tensor<1, 3> &x,
                                         const Tensor<1, 3> &d) {
  FacetCrossing crossing{{0.5, 0.5}, 0.};
  crossing.distance = (point_of_facet(corners, crossing.at) - x) * d;
  for (unsigned int i = 0; i < Limits::iterations; ++i) {
    const auto [g_1, g_2] = tangents(corners, crossing.at);
    Tensor<2, 3> A;
    for (unsigned int k = 0; k < 3; ++k) {
      A[k][0] = g_1[k];
      A[k][1] = g_2[k];
      A[k][2] = -d[k];
    }
    const auto step = solve_linear(A, x + crossing.distance * d - point_of_facet(corners, crossing.at));
    if (!step || !(std::abs((*step)[0]) + std::abs((*step)[1]) < Limits::diverged))
      return {};
    crossing.at[0] += (*step)[0];
    crossing.at[1] += (*step)[1];
    crossing.distance += (*step)[2];
    if (std::abs((*step)[0]) + std::abs((*step)[1]) < Limits::converged)
      return crossing;
  }
  return {};
}

} // namespace billet
