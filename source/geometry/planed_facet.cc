// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/planed_facet.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

PlanedFacet::PlanedFacet(const FacetCorners &corners)
    : centre_(0.25 * (corners[0] + corners[1] + corners[2] + corners[3])), diagonals_{corners[3] - corners[0],
                                                                                      corners[2] -
                                                                                          corners[1]} {
  const Tensor<1, 3> area_vector = dealii::cross_product_3d(diagonals_[0], diagonals_[1]);
  if (!facet::has_area(diagonals_[0], diagonals_[1], area_vector))
    return;
  double_area_ = area_vector.norm();
  normal_ = area_vector / double_area_;
  for (unsigned int a = 0; a < 4; ++a) {
    const Tensor<1, 3> arm = corners[a] - centre_;
    corners_[a] = arm - (arm * normal_) * normal_;
  }
}

void PlanedFacet::locate(const Tensor<1, 3> &in_plane, const double zone, FacetProjection &projection) const {
  projection.excess = 0.;
  projection.share = 1.;
  for (unsigned int i = 0; i < 4; ++i) {
    const Tensor<1, 3> &from = corners_[facet::around[i]], &to = corners_[facet::around[(i + 1) % 4]];
    if (!((to - from).norm_square() > 0.)) // the tip of a triangle is no border
      continue;
    const double distance = 2. * cross(to - from, in_plane - from) / double_area_;
    projection.excess = std::max(projection.excess, -distance);
    projection.share *= facet::share_at(distance, zone);
  }
}

std::array<double, 2> PlanedFacet::compute_parameters(const Tensor<1, 3> &in_plane) const {
  // in_plane = ξ e_1 + η e_2 + ξη e_3. The cross product with e_1 + η e_3 leaves A η² + B η + C = 0, whose
  // slope at the root is the Jacobian: the root where that is positive.
  const auto &x = corners_;
  const Tensor<1, 3> e_1 = 0.25 * (x[1] + x[3] - x[0] - x[2]), e_2 = 0.25 * (x[2] + x[3] - x[0] - x[1]),
                     e_3 = 0.25 * (x[0] + x[3] - x[1] - x[2]);
  const double A = cross(e_3, e_2), B = cross(in_plane, e_3) + cross(e_1, e_2), C = cross(in_plane, e_1);
  const double root = std::sqrt(std::max(0., B * B - 4. * A * C));
  const auto into_range = [](const double value) { return std::min(std::max(value, -1.), 1.); };
  double eta = 0.;
  if (B + root > 0.)
    eta = -2. * C / (B + root);
  else if (A != 0.)
    eta = (root - B) / (2. * A);
  eta = into_range(eta);
  const Tensor<1, 3> along = e_1 + eta * e_3;
  const double square = along.norm_square();
  // At the tip of a triangle ξ means nothing.
  const double xi = square > 0. ? into_range((in_plane - eta * e_2) * along / square) : 0.;
  return {xi, eta};
}

FacetProjection PlanedFacet::project(const Tensor<1, 3> &x, const FacetLimits &limits,
                                     const std::array<double, 2> &) const {
  FacetProjection projection;
  if (!(double_area_ > 0.))
    return projection;
  projection.normal = normal_;
  const Tensor<1, 3> arm = x - centre_;
  projection.gap = arm * normal_;
  const Tensor<1, 3> in_plane = arm - projection.gap * normal_;
  locate(in_plane, limits.zone, projection);
  projection.exists = projection.excess <= limits.tolerance && projection.gap >= -limits.reach;
  if (!projection.exists)
    return projection;
  projection.parameters = compute_parameters(in_plane);
  projection.weights = facet::weights(projection.parameters);
  const Tensor<1, 3> missing = in_plane - facet::interpolate(projection.weights, corners_);
  const double alpha = cross(missing, diagonals_[1]) / double_area_,
               beta = cross(diagonals_[0], missing) / double_area_;
  projection.weights[3] += alpha;
  projection.weights[0] -= alpha;
  projection.weights[2] += beta;
  projection.weights[1] -= beta;
  return projection;
}

} // namespace billet
