// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/assumed_strain.h"

#include "billet/mechanics/modal_geometry.h"

#include <cmath>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

namespace {

SymmetricTensor<2, 3> symmetric_product(const Tensor<1, 3> &a, const Tensor<1, 3> &b) {
  return dealii::symmetrize(dealii::outer_product(a, b));
}

Tensor<1, 3> column(const Tensor<2, 3> &A, const unsigned int k) {
  Tensor<1, 3> result;
  for (unsigned int i = 0; i < 3; ++i)
    result[i] = A[i][k];
  return result;
}

/// The place of the mode that belongs to the product of these two directions.
unsigned int bending_mode(const unsigned int j, const unsigned int k) { return 3 + (3 - j - k); }

/// h_k of (L1).
SymmetricTensor<2, 3> linear_strain(const unsigned int k, const Tensor<2, 3> &J, const Tensor<2, 3> &inverse,
                                    const std::array<Tensor<1, 3>, 4> &hourglass, const double thinning) {
  const auto row = [&inverse](const unsigned int i) { return inverse[i]; }; // the dual a^i
  const Tensor<1, 3> n = row(k) / row(k).norm();
  SymmetricTensor<2, 3> h;
  double plane_sum = 0.; // Σ η_ij d^i·d^j
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j) {
      if (i == k || j == k)
        continue;
      const Tensor<1, 3> di = row(i) - (row(i) * n) * n, dj = row(j) - (row(j) * n) * n;
      const double eta = 0.5 * (column(J, i) * hourglass[bending_mode(j, k) - 3] +
                                column(J, j) * hourglass[bending_mode(i, k) - 3]);
      h += eta * symmetric_product(di, dj);
      plane_sum += eta * (di * dj);
    }
  return h - thinning * plane_sum * symmetric_product(n, n);
}

} // namespace

bool compute_assumed_strain(const ElementVectors &positions, const ElementVectors &displacements,
                            const double poisson, PointDeformations &result) {
  const ModalGeometry geometry(positions);
  const auto moved = compute_modes(displacements);
  Tensor<2, 3> J_0, dJ; // (a_1 a_2 a_3) of the undeformed brick, and (F̄ − I) times that
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i) {
      J_0[i][k] = geometry.modes[k][i];
      for (unsigned int m = 0; m < n_linear_modes; ++m)
        dJ[i][k] += geometry.beta[m][k] * moved[m][i];
    }
  if (!(dealii::determinant(J_0) > 0.) || !(geometry.volume > 0.))
    return false;
  const Tensor<2, 3> H = dJ * dealii::invert(J_0), J = J_0 + dJ;
  Tensor<2, 3> F = H;
  for (unsigned int i = 0; i < 3; ++i)
    F[i][i] += 1.;
  if (!(dealii::determinant(F) > 0.))
    return false;
  const Tensor<2, 3> inverse = dealii::invert(J);
  std::array<Tensor<1, 3>, 4> hourglass; // b̂_1, b̂_2, b̂_3, ĉ
  for (unsigned int m = 0; m < 4; ++m)
    hourglass[m] = moved[3 + m] - H * geometry.modes[3 + m];

  const double thinning = 0.5 * (std::sqrt(3. + 6. * poisson / (1. - poisson)) - 1.);
  std::array<SymmetricTensor<2, 3>, 3> linear, bilinear; // bilinear[j] goes with ξ_k ξ_l
  const double fourth = std::sqrt(2. * (1. + poisson) / 3.);
  for (unsigned int k = 0; k < 3; ++k) {
    linear[k] = linear_strain(k, J, inverse, hourglass, thinning);
    const Tensor<1, 3> t = column(J, k) / column(J, k).norm();
    bilinear[k] = fourth * (t * hourglass[3]) / column(J, k).norm() *
                  (1.5 * symmetric_product(t, t) - 0.5 * dealii::unit_symmetric_tensor<3>());
  }
  const double place = 1. / std::sqrt(3.);
  for (unsigned int q = 0; q < n_element_points; ++q) {
    SymmetricTensor<2, 3> Y = dealii::unit_symmetric_tensor<3>();
    for (unsigned int k = 0; k < 3; ++k)
      Y += place * corner(q, k) * linear[k] +
           place * place * corner(q, (k + 1) % 3) * corner(q, (k + 2) % 3) * bilinear[k];
    const double determinant = dealii::determinant(Y);
    if (!(determinant > 0.))
      return false;
    result.F[q] = (Tensor<2, 3>(Y) * F) / std::cbrt(determinant);
    result.volumes[q] = geometry.volume / n_element_points;
  }
  return true;
}

} // namespace billet
