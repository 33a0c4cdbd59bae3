// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_reaction.h"

namespace billet {

using dealii::Tensor;

FacetCorners compute_facet_reaction(const FacetCorners &corners, const std::array<double, 4> &weights,
                                    const Tensor<1, 3> &x, const Tensor<1, 3> &force) {
  const Tensor<1, 3> centre = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  FacetCorners arms;
  Tensor<2, 3> second_moment;
  for (unsigned int a = 0; a < 4; ++a) {
    arms[a] = corners[a] - centre;
    second_moment -= dealii::outer_product(arms[a], arms[a]);
    for (unsigned int i = 0; i < 3; ++i)
      second_moment[i][i] += arms[a].norm_square();
  }
  const Tensor<1, 3> across = (x - centre) - facet::interpolate(weights, arms);
  const Tensor<1, 3> omega = dealii::invert(second_moment) * dealii::cross_product_3d(force, across);
  FacetCorners forces;
  for (unsigned int a = 0; a < 4; ++a)
    forces[a] = dealii::cross_product_3d(omega, arms[a]) - weights[a] * force;
  return forces;
}

} // namespace billet
