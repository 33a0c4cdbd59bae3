// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/reference_point.h"

#include <deal.II/base/geometry_info.h>

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;
using Unit = dealii::GeometryInfo<3>;

namespace {

struct Limits {
  /// Steps of Newton's method, in reference coordinates.
  static constexpr double converged = 1e-10, diverged = 100.;
  /// Distance from the point, relative to the coordinates, that is round-off.
  static constexpr double reached = 1e-14;
};

} // namespace

std::optional<Tensor<1, 3>> solve_linear(const Tensor<2, 3> &A, const Tensor<1, 3> &b) {
  const double det = dealii::determinant(A);
  if (det == 0. || !std::isfinite(det))
    return {};
  return dealii::invert(A) * b;
}

std::optional<dealii::Point<3>> find_reference_point(const ElementVectors &corners, const Tensor<1, 3> &point,
                                                     const ReferenceLimits &limits) {
  const dealii::Point<3> centre(0.5, 0.5, 0.5);
  dealii::Point<3> xi = centre;
  double reached = 0.;
  for (const double coordinate : corners)
    reached = std::max(reached, Limits::reached * std::abs(coordinate));
  for (unsigned int i = 0; i < limits.max_iterations; ++i) {
    Tensor<1, 3> x;
    Tensor<2, 3> jacobian;
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const double value = Unit::d_linear_shape_function(xi, a);
      const auto gradient = Unit::d_linear_shape_function_gradient(xi, a);
      for (unsigned int k = 0; k < 3; ++k) {
        x[k] += corners[3 * a + k] * value;
        for (unsigned int j = 0; j < 3; ++j)
          jacobian[k][j] += corners[3 * a + k] * gradient[j];
      }
    }
    // On the axis of a prism the next step would be round-off. A flat element has no first step.
    if (i > 0 && (point - x).norm() <= reached)
      return xi;
    const auto step = solve_linear(jacobian, point - x);
    if (!step || !(step->norm() < Limits::diverged))
      return {};
    xi += *step;
    if ((xi - centre).norm() > limits.far)
      return {};
    if (step->norm() < Limits::converged)
      return xi;
  }
  return {};
}

} // namespace billet
