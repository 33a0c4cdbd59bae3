// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/moduli.h"

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

/// Returns the largest row sum of the symmetric part of a square matrix, a bound of the largest
/// eigenvalue of that part.
template <class Matrix> double bound_eigenvalue(const Matrix &matrix) {
  double largest = 0.;
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    double sum = 0.;
    for (std::size_t j = 0; j < matrix.size(); ++j)
      sum += 0.5 * std::abs(matrix[i][j] + matrix[j][i]);
    largest = std::max(largest, sum);
  }
  return largest;
}

} // namespace

double bound_elastic_stiffness(const ElasticModuli &moduli, const dealii::SymmetricTensor<2, 3> &tau) {
  const double mean = dealii::trace(tau) / 3., mises = std::sqrt(1.5) * dealii::deviator(tau).norm();
  return std::max(3. * moduli.bulk, 2. * moduli.shear) + 4. * std::abs(mean) + 3. * mises;
}

double bound_by_moduli(const SpatialModuli &moduli, const dealii::SymmetricTensor<2, 3> &tau) {
  // In an orthonormal base of the symmetric tensors, whose shears are √2 d12.
  SpatialModuli orthonormal;
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j)
      orthonormal[i][j] = (i < 3 ? 1. : std::sqrt(2.)) * (j < 3 ? 1. : std::sqrt(2.)) * moduli[i][j];
  return bound_eigenvalue(orthonormal) + tau.norm();
}

double bound_by_moduli(const GradientModuli &moduli, const dealii::SymmetricTensor<2, 3> &tau) {
  // Rows of τ11, τ12, τ13, τ21, ...
  constexpr std::array<std::size_t, 9> rows{0, 3, 4, 3, 1, 5, 4, 5, 2};
  std::array<std::array<double, 9>, 9> full;
  for (std::size_t i = 0; i < 9; ++i)
    full[i] = moduli[rows[i]];
  return bound_eigenvalue(full) + 3. * std::abs(moduli.volumetric) + tau.norm();
}

} // namespace billet
