// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/edge_fading.h"

#include <algorithm>
#include <cmath>

namespace billet {

EdgeFading compute_edge_fading(const RigidSurface::EdgePoint &edge_point, const double width,
                               const HardeningSpring &penalty, const double gap) {
  const double q = edge_point.beyond / width, left = 1. - q * q;
  // s′, s″.
  const double slope = -4. * q * left / width, bend = (12. * q * q - 4.) / (width * width);
  const double penetration = std::max(-gap, 0.), spring = penalty.energy(penetration),
               pressure = penalty.pressure(penetration);
  const dealii::Tensor<1, 3> &n = edge_point.normal, &e = edge_point.outward;
  EdgeFading fading;
  fading.share = left * left;
  fading.push = -spring * slope * e;
  fading.pressure_slope = pressure * slope * e;
  fading.tangent = -pressure * slope * (dealii::outer_product(n, e) + dealii::outer_product(e, n)) +
                   spring * (bend * dealii::outer_product(e, e) + slope * edge_point.spreading);
  // |s′|/d <= 4/w², |s″| <= 8/w².
  fading.stiffness = 2. * pressure * std::abs(slope) + 12. * spring / (width * width);
  return fading;
}

} // namespace billet
