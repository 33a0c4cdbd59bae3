// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/planed_facet.h"

#include "billet/geometry/derivative.h"

#include <algorithm>
#include <cmath>

namespace billet {

template <class Number>
PlanedFacetOf<Number>::PlanedFacetOf(const facet::ExpansionOf<Number> &surface) : centre_(surface.e_0) {
  if (!surface.has_area())
    return;
  const Vector area_vector = surface.mean_area_vector();
  const Number area = area_vector.norm(), length = surface.e_1.norm();
  double_area_ = 8. * area;
  normal_ = area_vector / area;
  directions_[0] = surface.e_1 / length;
  directions_[1] = dealii::cross_product_3d(normal_, directions_[0]);
  e_1_ = {length, Number(0.)};
  e_2_ = {surface.e_2 * directions_[0], area / length};
  e_3_ = {surface.e_3 * directions_[0], surface.e_3 * directions_[1]};
  warp_ = surface.e_3 * normal_;
  std::array<InPlane, 4> x;
  for (unsigned int a = 0; a < 4; ++a) {
    x[a] = at(facet::signs[a][0], facet::signs[a][1]);
    square_of_radius_ =
        std::max(square_of_radius_, value_of(x[a][0] * x[a][0] + x[a][1] * x[a][1] + warp_ * warp_));
  }
  for (unsigned int i = 0; i < 4; ++i) {
    const InPlane &from = x[facet::around[i]], &to = x[facet::around[(i + 1) % 4]];
    const InPlane edge{to[0] - from[0], to[1] - from[1]};
    const Number factor = 2. / double_area_;
    borders_[i] = {{-factor * edge[1], factor * edge[0]}, factor * cross(from, edge)};
    if (!(edge[0] * edge[0] + edge[1] * edge[1] > 0.)) // the tip of a triangle is no edge
      borders_[i].offset = std::numeric_limits<double>::infinity();
  }
}

template <class Number> bool PlanedFacetOf<Number>::is_aside(const Vector &x, const double tolerance) const {
  if (!(double_area_ > 0.))
    return true;
  using std::abs;
  const Vector arm = x - centre_;
  const Number height = arm * normal_, maximum = (1. + 4. * tolerance) * radius() + abs(height);
  return arm.norm_square() - height * height > maximum * maximum;
}

template <class Number>
void PlanedFacetOf<Number>::locate(const InPlane &x, const double zone,
                                   FacetProjectionOf<Number> &projection) const {
  projection.excess = 0.;
  projection.share = 1.;
  for (const auto &[along, offset] : borders_) {
    const Number distance = along[0] * x[0] + along[1] * x[1] + offset;
    projection.excess = std::max(projection.excess, -value_of(distance));
    projection.share *= facet::share_at(distance, zone);
  }
}

template <class Number>
std::array<Number, 2> PlanedFacetOf<Number>::compute_parameters(const InPlane &x) const {
  // x = ξ e_1 + η e_2 + ξη e_3. The cross product with e_1 + η e_3 gives A η² + B η + C = 0, whose
  // slope at a root is the Jacobian. The right root has a positive Jacobian.
  using std::sqrt;
  const Number A = cross(e_3_, e_2_), B = cross(x, e_3_) + cross(e_1_, e_2_), C = cross(x, e_1_),
               square_of_root = B * B - 4. * A * C,
               root = square_of_root > 0. ? sqrt(square_of_root) : Number(0.);
  const auto into_range = [](const Number &value) {
    return value < -1. ? Number(-1.) : value > 1. ? Number(1.) : value;
  };
  Number eta = 0.;
  if (B + root > 0.)
    eta = -2. * C / (B + root);
  else if (A != 0.)
    eta = (root - B) / (2. * A);
  eta = into_range(eta);
  const auto along = [](const InPlane &e, const Number &at, const InPlane &e_3) {
    return InPlane{e[0] + at * e_3[0], e[1] + at * e_3[1]};
  };
  const auto square_of = [](const InPlane &e) -> Number { return e[0] * e[0] + e[1] * e[1]; };
  // See ExpansionOf::undefined_at().
  const double no_length = facet::tip * facet::tip * value_of(square_of(e_1_) + square_of(e_2_));
  const auto find_xi = [&]() {
    const InPlane along_xi = along(e_1_, eta, e_3_);
    const Number square = square_of(along_xi);
    return square > no_length
               ? into_range(((x[0] - eta * e_2_[0]) * along_xi[0] + (x[1] - eta * e_2_[1]) * along_xi[1]) /
                            square)
               : Number(0.);
  };
  Number xi = find_xi();
  if (!(square_of(along(e_2_, xi, e_3_)) > no_length)) {
    eta = 0.;
    xi = find_xi();
  }
  return {xi, eta};
}

template <class Number>
FacetProjectionOf<Number> PlanedFacetOf<Number>::project(const Vector &x, const FacetLimits &limits,
                                                         const Number &warp) const {
  FacetProjectionOf<Number> projection;
  if (!(double_area_ > 0.))
    return projection;
  projection.normal = normal_;
  const Vector arm = x - centre_;
  projection.gap = arm * normal_;
  const InPlane in_plane{arm * directions_[0], arm * directions_[1]};
  locate(in_plane, limits.zone, projection);
  if (!(projection.excess <= limits.tolerance))
    return projection;
  projection.parameters = compute_parameters(in_plane);
  projection.weights = facet::weights(projection.parameters);
  const InPlane reached = at(projection.parameters[0], projection.parameters[1]);
  const InPlane missing{in_plane[0] - reached[0], in_plane[1] - reached[1]};
  // The diagonals are 2 (e_1 + e_2) and 2 (e_2 − e_1).
  const Number with_1 = cross(missing, e_1_), with_2 = cross(missing, e_2_),
               alpha = 2. * (with_2 - with_1) / double_area_, beta = -2. * (with_1 + with_2) / double_area_;
  projection.weights[3] += alpha;
  projection.weights[0] -= alpha;
  projection.weights[2] += beta;
  projection.weights[1] -= beta;
  const auto &w = projection.weights;
  projection.gap -= warp * (w[0] + w[3] - w[1] - w[2]);
  projection.exists = true;
  return projection;
}

template class PlanedFacetOf<double>;
template class PlanedFacetOf<Derivative>;

} // namespace billet
