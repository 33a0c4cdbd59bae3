// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_MODAL_GEOMETRY_H
#define BILLET_MECHANICS_MODAL_GEOMETRY_H

#include "billet/mechanics/mean_dilatation.h"

namespace billet {

/// Returns coordinate i of corner a of the bi-unit cube, ±1.
inline double corner(const unsigned int a, const unsigned int i) { return ((a >> i) & 1U) != 0U ? 1. : -1.; }

constexpr unsigned int n_element_modes = 7; ///< a_1, a_2, a_3, b_1, b_2, b_3, c
/// Modes that contribute to the mean gradient: all but c.
constexpr unsigned int n_linear_modes = 6;

/// Directions of each mode, as the bits ξ, η, ζ.
constexpr std::array<unsigned int, n_element_modes> mode_places = {1, 2, 4, 6, 5, 3, 7};

/// Value of mode m at node a, ±1; a nodal vector's mode is the mean of its products with these.
constexpr std::array<std::array<double, n_element_nodes>, n_element_modes> mode_values = [] {
  std::array<std::array<double, n_element_nodes>, n_element_modes> values{};
  for (unsigned int m = 0; m < n_element_modes; ++m)
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      values[m][a] = 1.;
      for (unsigned int i = 0; i < 3; ++i)
        values[m][a] *= ((mode_places[m] >> i) & 1U) != 0U && ((a >> i) & 1U) == 0U ? -1. : 1.;
    }
  return values;
}();

/// Returns the modes of a nodal vector.
inline std::array<dealii::Tensor<1, 3>, n_element_modes> compute_modes(const ElementVectors &values) {
  std::array<dealii::Tensor<1, 3>, n_element_modes> modes;
  for (unsigned int m = 0; m < n_element_modes; ++m)
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        modes[m][i] += 0.125 * mode_values[m][a] * values[3 * a + i];
  return modes;
}

/// Brick in terms of its modes, x = a_0 + a_1 ξ + a_2 η + a_3 ζ + b_1 ηζ + b_2 ζξ + b_3 ξη + c ξηζ,
/// the one-point element's geometry: doc/theory.md, (X1), (X2).
struct ModalGeometry {
  std::array<dealii::Tensor<1, 3>, n_element_modes> modes;
  double volume = 0.;
  /// The mean of F over the undeformed brick times (a_1 a_2 a_3)_0 has the columns Σ_m β_mk x_m.
  std::array<std::array<double, 3>, n_linear_modes> beta;

  explicit ModalGeometry(const ElementVectors &positions) : modes(compute_modes(positions)) {
    std::array<dealii::Tensor<1, 3>, n_linear_modes> derivatives; // ∂V/∂m
    for (unsigned int i = 0; i < 3; ++i) {
      const unsigned int j = (i + 1) % 3, k = (i + 2) % 3;
      derivatives[i] =
          8. * cross_product_3d(modes[j], modes[k]) - 8. / 3. * cross_product_3d(modes[3 + j], modes[3 + k]);
      derivatives[3 + i] =
          -8. / 3. * (cross_product_3d(modes[j], modes[3 + k]) + cross_product_3d(modes[3 + j], modes[k]));
    }
    for (unsigned int m = 0; m < n_linear_modes; ++m)
      volume += derivatives[m] * modes[m] / 3.; // homogeneous of degree three
    for (unsigned int m = 0; m < n_linear_modes; ++m)
      for (unsigned int k = 0; k < 3; ++k)
        beta[m][k] = derivatives[m] * modes[k] / volume;
  }
};

/// Returns what a number of b_1, b_2, b_3 and c in an element's own directions is in one of its
/// parts, (R5) of doc/theory. The element is divided into eight. h has the modes in its rows.
template <class HourglassVector>
HourglassVector hourglass_of_child(const HourglassVector &h, const unsigned int child) {
  HourglassVector of_child = h;
  for (unsigned int k = 0; k < 3; ++k) {
    for (unsigned int m = 0; m < 3; ++m)
      of_child[m][k] = 0.5 * (h[m][k] + 0.5 * corner(child, m) * h[3][k]);
    of_child[3][k] = 0.25 * h[3][k];
  }
  return of_child;
}

} // namespace billet

#endif
