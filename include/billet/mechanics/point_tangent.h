// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_POINT_TANGENT_H
#define BILLET_MECHANICS_POINT_TANGENT_H

#include "billet/material/moduli.h"
#include "billet/mechanics/mean_dilatation.h"

namespace billet {

// Tangent of the forces f_a = w τ g_a that a point with the Kirchhoff stress τ exerts on n nodes,
// or modes, with gradients g_a = ∂N_a/∂x. It is added to the first 3 n rows and columns of a
// row-major matrix with rows of `width` numbers.

template <std::size_t n> using Gradients = std::array<std::array<double, 3>, n>;

/// Returns τ g_b for each gradient; component i is at 3 b + i.
template <std::size_t n>
std::array<double, 3 * n> multiply_gradients(const dealii::SymmetricTensor<2, 3> &tau,
                                             const Gradients<n> &gradients) {
  std::array<double, 3 * n> result;
  for (std::size_t b = 0; b < n; ++b)
    for (unsigned int i = 0; i < 3; ++i)
      result[3 * b + i] =
          tau[i][0] * gradients[b][0] + tau[i][1] * gradients[b][1] + tau[i][2] * gradients[b][2];
  return result;
}

/// Rows of δτ or c : d that multiply the gradient's components in component i of a force.
constexpr unsigned int stress_rows[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};

/// Adds K_ab = w {B_aᵀ c B_b + g_a·τ·g_b 1}.
template <std::size_t n>
void add_point_tangent(const double w, const Gradients<n> &g, const dealii::SymmetricTensor<2, 3> &tau,
                       const SpatialModuli &c, double *matrix, const std::size_t width) {
  const std::array<double, 3 *n> tau_g = multiply_gradients(tau, g);
  std::array<std::array<double, 3 * n>, 6> cB;
  for (unsigned int r = 0; r < 6; ++r)
    for (std::size_t b = 0; b < n; ++b)
      for (unsigned int j = 0; j < 3; ++j)
        cB[r][3 * b + j] = w * (c[r][stress_rows[j][0]] * g[b][0] + c[r][stress_rows[j][1]] * g[b][1] +
                                c[r][stress_rows[j][2]] * g[b][2]);
  for (std::size_t a = 0; a < n; ++a) {
    for (unsigned int i = 0; i < 3; ++i) {
      double *row = matrix + (3 * a + i) * width;
      const auto &first = cB[stress_rows[i][0]], &second = cB[stress_rows[i][1]],
                 &third = cB[stress_rows[i][2]];
      for (std::size_t k = 0; k < 3 * n; ++k)
        row[k] += g[a][0] * first[k] + g[a][1] * second[k] + g[a][2] * third[k];
    }
    for (std::size_t b = 0; b < n; ++b) {
      const double geometric =
          w * (g[a][0] * tau_g[3 * b] + g[a][1] * tau_g[3 * b + 1] + g[a][2] * tau_g[3 * b + 2]);
      for (unsigned int i = 0; i < 3; ++i)
        matrix[(3 * a + i) * width + 3 * b + i] += geometric;
    }
  }
}

/// Returns δτ for each displacement: A : (e_j ⊗ g_b) at 3 b + j.
template <std::size_t n>
std::array<std::array<double, 3 * n>, 6> multiply_gradients(const GradientModuli &A, const Gradients<n> &g) {
  std::array<std::array<double, 3 * n>, 6> result;
  for (unsigned int r = 0; r < 6; ++r)
    for (std::size_t b = 0; b < n; ++b)
      for (std::size_t j = 0; j < 3; ++j)
        result[r][3 * b + j] = A[r][3 * j] * g[b][0] + A[r][3 * j + 1] * g[b][1] + A[r][3 * j + 2] * g[b][2];
  return result;
}

/// Adds K_aibj = w {(δτ_bj g_a)_i − (τ g_b)_i g_aj}, with δτ_bj the derivative of the stress by
/// displacement bj.
template <std::size_t n>
void add_point_tangent(const double w, const Gradients<n> &g, const dealii::SymmetricTensor<2, 3> &tau,
                       const std::array<std::array<double, 3 * n>, 6> &stress_rates, double *matrix,
                       const std::size_t width) {
  const std::array<double, 3 *n> tau_g = multiply_gradients(tau, g);
  for (std::size_t a = 0; a < n; ++a)
    for (unsigned int i = 0; i < 3; ++i) {
      double *row = matrix + (3 * a + i) * width;
      const auto &first = stress_rates[stress_rows[i][0]], &second = stress_rates[stress_rows[i][1]],
                 &third = stress_rates[stress_rows[i][2]];
      for (std::size_t k = 0; k < 3 * n; ++k)
        row[k] += w * (g[a][0] * first[k] + g[a][1] * second[k] + g[a][2] * third[k] -
                       tau_g[k / 3 * 3 + i] * g[a][k % 3]);
    }
}

/// Returns the symmetric part of the moduli.
SpatialModuli symmetrise(const SpatialModuli &moduli);

/// Replaces the matrix with its symmetric part.
void symmetrise(ElementMatrix &matrix);

} // namespace billet

#endif
