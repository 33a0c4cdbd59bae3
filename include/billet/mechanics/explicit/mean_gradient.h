// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_MEAN_GRADIENT_H
#define BILLET_MECHANICS_EXPLICIT_MEAN_GRADIENT_H

#include "billet/mechanics/explicit/brick.h"

// Mean deformation gradient F̄ = (1/V) ∫ F dV of a brick, from J̄ = F̄ (a_1, a_2, a_3)_0, which is
// linear in the modes.

namespace billet::explicit_kernels {
namespace {

/// Computes the columns of J̄.
BILLET_INLINE void compute_mean(const Modes &modes, const Number *constants, Real columns[3][3]) {
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i) {
      Real sum{};
      for (unsigned int m = 0; m < 6; ++m)
        sum += modes.m[m][i] * load(constants + (mean_gradient::beta + 3 * m + k) * n_lanes);
      columns[k][i] = sum;
    }
}

/// Maps of the mean deformation.
struct MeanMotion {
  Map now, before; ///< `before` the step, in float only
  Real d[3][3];    ///< columns of J̄ minus those before the step, on request
  Real J;          ///< inaccurate for small changes
};

template <bool with_step>
BILLET_INLINE void compute_mean_motion(const Motion &motion, const Number *constants, MeanMotion &mean) {
  compute_mean(motion.x, constants, mean.now.j);
  mean.now.complete();
  mean.J = mean.now.det * load(constants + mean_gradient::inverse_det * n_lanes);
  if constexpr (with_step || is_single)
    compute_mean(motion.delta, constants, mean.d);
  if constexpr (is_single) {
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        mean.before.j[k][i] = mean.now.j[k][i] - mean.d[k][i];
    mean.before.complete();
  }
}

/// Returns det J̄ minus that before the step, without cancellation error.
BILLET_INLINE Real compute_change(const MeanMotion &mean) {
  Real middle[3];
  cross(mean.d[1], mean.now.j[2], middle);
  return dot(mean.d[0], mean.now.cofactor[0]) +
         (dot(mean.before.j[0], middle) + dot(mean.d[2], mean.before.cofactor[2]));
}

} // namespace
} // namespace billet::explicit_kernels

#endif
