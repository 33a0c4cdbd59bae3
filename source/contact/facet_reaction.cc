// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_reaction.h"

#include "billet/geometry/derivative.h"

namespace billet {

using dealii::Tensor;

template <class Number>
FacetReactionOf<Number>::FacetReactionOf(const facet::ExpansionOf<Number> &surface) : surface_(surface) {
  // r_I = ± e_1 ± e_2 ± e_3, with signs that are orthogonal to each other.
  Tensor<2, 3, Number> second_moment;
  for (const Tensor<1, 3, Number> *e : {&surface.e_1, &surface.e_2, &surface.e_3}) {
    second_moment -= 4. * dealii::outer_product(*e, *e);
    for (unsigned int i = 0; i < 3; ++i)
      second_moment[i][i] += 4. * e->norm_square();
  }
  inverse_second_moment_ = dealii::invert(second_moment);
}

template <class Number>
FacetCornersOf<Number> FacetReactionOf<Number>::operator()(const std::array<Number, 4> &weights,
                                                           const Tensor<1, 3, Number> &x,
                                                           const Tensor<1, 3, Number> &force) const {
  const auto &[e_0, e_1, e_2, e_3] = surface_;
  const Number xi = weights[1] + weights[3] - weights[0] - weights[2],
               eta = weights[2] + weights[3] - weights[0] - weights[1],
               both = weights[0] + weights[3] - weights[1] - weights[2];
  const Tensor<1, 3, Number> across = (x - e_0) - (xi * e_1 + eta * e_2 + both * e_3);
  const Tensor<1, 3, Number> omega = inverse_second_moment_ * dealii::cross_product_3d(force, across);
  const Tensor<1, 3, Number> f_1 = dealii::cross_product_3d(omega, e_1),
                             f_2 = dealii::cross_product_3d(omega, e_2),
                             f_3 = dealii::cross_product_3d(omega, e_3);
  return {f_3 - f_1 - f_2 - weights[0] * force, f_1 - f_2 - f_3 - weights[1] * force,
          f_2 - f_1 - f_3 - weights[2] * force, f_1 + f_2 + f_3 - weights[3] * force};
}

template class FacetReactionOf<double>;
template class FacetReactionOf<Derivative>;

} // namespace billet
