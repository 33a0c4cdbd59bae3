// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_STABILITY_H
#define BILLET_MATERIAL_STABILITY_H

#include "billet/material/hencky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace billet {

using Stretches = std::array<double, 3>;

/// Returns the minimum stiffness of plane waves, over the shear modulus, in an isotropic elastic
/// law at these principal stretches. It is the minimum eigenvalue, over directions n, of
///   Q_ik(n) = n_p n_q c_ipkq + δ_ik n_p τ_pq n_q                                              (M7)
/// (Legendre-Hadamard condition; Ogden 1997, ch. 6). If it is negative, such waves grow. The
/// directions form a grid on an octant in the principal frame, 15 degrees apart; the other octants
/// follow by symmetry. Returns −∞ if the law has no stress.
template <class Law>
double min_wave_stiffness(const Law &law, const double shear, const Stretches &stretches) {
  constexpr unsigned int entry[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  constexpr unsigned int n_angles = 6; // intervals per right angle
  dealii::Tensor<2, 3> F;
  for (unsigned int i = 0; i < 3; ++i)
    F[i][i] = stretches[i];
  typename Law::History none;
  dealii::SymmetricTensor<2, 3> tau;
  SpatialModuli c;
  if (!law.update(F, none, none, tau, &c))
    return -std::numeric_limits<double>::infinity();
  const double step = std::acos(0.) / n_angles;
  double minimum = std::numeric_limits<double>::infinity();
  for (unsigned int a = 0; a <= n_angles; ++a)
    for (unsigned int b = 0; b <= n_angles; ++b) {
      const std::array<double, 3> n = {std::sin(a * step) * std::cos(b * step),
                                       std::sin(a * step) * std::sin(b * step), std::cos(a * step)};
      dealii::SymmetricTensor<2, 3> Q;
      for (unsigned int p = 0; p < 3; ++p)
        for (unsigned int q = 0; q < 3; ++q)
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int k = i; k < 3; ++k)
              Q[i][k] += n[p] * n[q] * (c[entry[i][p]][entry[k][q]] + (i == k ? tau[p][q] : 0.));
      minimum = std::min(minimum, dealii::eigenvalues(Q)[2]);
    }
  return minimum / shear;
}

/// Returns the minimum stiffness of plane waves, over the shear modulus, in the hypoelastic law dev
/// τ̊ = 2G dev d. The law has the spin of the material, and the path is straight. For shear waves
/// it is G − (τ_max − τ_min)/2, τ_max − τ_min = 2G ln(λ_max/λ_min). For waves along a principal
/// direction it is κ (1 − ln J) + 4/3 G − 2G dev ln λ (M8).
inline double min_wave_stiffness_of_rates(const ElasticModuli &elastic, const Stretches &stretches) {
  const auto [minimum, maximum] = std::minmax_element(stretches.begin(), stretches.end());
  if (!(*minimum > 0.))
    return -std::numeric_limits<double>::infinity();
  const double volumetric = std::log(stretches[0]) + std::log(stretches[1]) + std::log(stretches[2]);
  const double along = elastic.bulk / elastic.shear * (1. - volumetric) + 4. / 3. -
                       2. * (std::log(*maximum) - volumetric / 3.);
  return std::min({1. - std::log(*maximum / *minimum), along, 1.});
}

} // namespace billet

#endif
