// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_reaction.h"

namespace billet {

using dealii::Tensor;

FacetReaction::FacetReaction(const facet::Expansion &surface) : surface_(surface) {
  // r_I = ± e_1 ± e_2 ± e_3, with signs that are orthogonal to each other.
  Tensor<2, 3> second_moment;
  for (const Tensor<1, 3> *e : {&surface.e_1, &surface.e_2, &surface.e_3}) {
    second_moment -= 4. * dealii::outer_product(*e, *e);
    for (unsigned int i = 0; i < 3; ++i)
      second_moment[i][i] += 4. * e->norm_square();
  }
  inverse_second_moment_ = dealii::invert(second_moment);
}

FacetCorners FacetReaction::operator()(const std::array<double, 4> &weights, const Tensor<1, 3> &x,
                                       const Tensor<1, 3> &force) const {
  const auto &[e_0, e_1, e_2, e_3] = surface_;
  const double xi = weights[1] + weights[3] - weights[0] - weights[2],
               eta = weights[2] + weights[3] - weights[0] - weights[1],
               both = weights[0] + weights[3] - weights[1] - weights[2];
  const Tensor<1, 3> across = (x - e_0) - (xi * e_1 + eta * e_2 + both * e_3);
  const Tensor<1, 3> omega = inverse_second_moment_ * dealii::cross_product_3d(force, across);
  const Tensor<1, 3> f_1 = dealii::cross_product_3d(omega, e_1), f_2 = dealii::cross_product_3d(omega, e_2),
                     f_3 = dealii::cross_product_3d(omega, e_3);
  return {f_3 - f_1 - f_2 - weights[0] * force, f_1 - f_2 - f_3 - weights[1] * force,
          f_2 - f_1 - f_3 - weights[2] * force, f_1 + f_2 + f_3 - weights[3] * force};
}

} // namespace billet
