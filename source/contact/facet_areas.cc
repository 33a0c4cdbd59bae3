// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_areas.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

double compute_area_share(const FacetCorners &x, const unsigned int corner, const Tensor<1, 3> &normal) {
  // ν = (e_1 + η e_3) × (e_2 + ξ e_3), in which e_3 × e_3 vanishes: three triple products for all points.
  const Tensor<1, 3> e_1 = 0.25 * (x[1] + x[3] - x[0] - x[2]), e_2 = 0.25 * (x[2] + x[3] - x[0] - x[1]),
                     e_3 = 0.25 * (x[0] + x[3] - x[1] - x[2]);
  const double constant = dealii::cross_product_3d(e_1, e_2) * normal,
               along_xi = dealii::cross_product_3d(e_1, e_3) * normal,
               along_eta = dealii::cross_product_3d(e_3, e_2) * normal;
  static const double gauss = 1. / std::sqrt(3.);
  double share = 0.;
  for (const auto &sign : facet::signs) {
    const std::array<double, 2> at{gauss * sign[0], gauss * sign[1]};
    share += facet::weights(at)[corner] * std::max(0., -(constant + at[0] * along_xi + at[1] * along_eta));
  }
  return share;
}

} // namespace billet
