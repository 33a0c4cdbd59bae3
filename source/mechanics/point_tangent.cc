// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/point_tangent.h"

namespace billet {

SpatialModuli symmetrise(const SpatialModuli &moduli) {
  SpatialModuli result;
  for (unsigned int i = 0; i < 6; ++i)
    for (unsigned int j = 0; j < 6; ++j)
      result[i][j] = 0.5 * (moduli[i][j] + moduli[j][i]);
  return result;
}

void symmetrise(ElementMatrix &matrix) {
  for (std::size_t r = 0; r < n_element_dofs; ++r)
    for (std::size_t c = r + 1; c < n_element_dofs; ++c) {
      double &upper = matrix[r * n_element_dofs + c], &lower = matrix[c * n_element_dofs + r];
      upper = lower = 0.5 * (upper + lower);
    }
}

} // namespace billet
