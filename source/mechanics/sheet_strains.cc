// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/sheet_strains.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

Tensor<1, 3> find_sheet_normal(const ElementVectors &positions) {
  const auto modes = compute_modes(positions);
  std::array<unsigned int, 3> axes{{0, 1, 2}};
  std::sort(axes.begin(), axes.end(),
            [&](const unsigned int a, const unsigned int b) { return modes[a].norm() > modes[b].norm(); });
  const Tensor<1, 3> normal = dealii::cross_product_3d(modes[axes[0]], modes[axes[1]]);
  return normal / normal.norm();
}

SheetStrains compute_sheet_strains(const Tensor<2, 3> &F, const Tensor<1, 3> &normal) {
  Tensor<1, 3> across;
  across[std::abs(normal[0]) < 0.6 ? 0 : 1] = 1.; // not along the normal
  Tensor<1, 3> first = dealii::cross_product_3d(normal, across);
  first /= first.norm();
  const Tensor<1, 3> u = F * first, v = F * dealii::cross_product_3d(normal, first);
  const double mean = 0.5 * (u * u + v * v), half = 0.5 * (u * u - v * v), radius = std::hypot(half, u * v),
               J = dealii::determinant(F), area = dealii::cross_product_3d(u, v).norm();
  if (!(mean - radius > 0.) || !(J > 0.) || !std::isfinite(J))
    return {};
  return {0.5 * std::log(mean + radius), 0.5 * std::log(mean - radius), 1. - J / area};
}

} // namespace billet
