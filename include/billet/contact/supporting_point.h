// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SUPPORTING_POINT_H
#define BILLET_CONTACT_SUPPORTING_POINT_H

#include "billet/contact/traction.h"
#include "billet/friction/friction_law.h"

#include <deal.II/base/tensor.h>

#include <algorithm>

namespace billet {

/// Point of a body where contact has a stiffness.
struct SupportingPoint {
  /// State of friction at the point.
  enum class Friction {
    none,
    sticks, ///< resists every motion along the surface
    slips   ///< resists a motion across the slip or against it, but not along it
  };
  dealii::Tensor<1, 3> position; ///< [length]
  dealii::Tensor<1, 3> normal;   ///< unit, out of the touched surface
  Friction friction = Friction::none;
  dealii::Tensor<1, 3> slip; ///< unit: actual or potential direction of slip on the touched surface
  double use = 0.;           ///< the ratio of traction to friction limit at a point that sticks

  /// Whether friction is at its limit, or nearly so.
  bool is_near_limit() const {
    constexpr double nearly = 0.9;
    return friction == Friction::slips || (friction == Friction::sticks && use >= nearly);
  }
};

/// Makes the point at `position` with this traction on the body. Without tangential traction the
/// slip has no direction: such a point counts as frictionless.
inline SupportingPoint make_supporting_point(const dealii::Tensor<1, 3> &position,
                                             const dealii::Tensor<1, 3> &normal, const FrictionLaw &friction,
                                             const ContactStatus status,
                                             const dealii::Tensor<1, 3> &traction) {
  SupportingPoint point{position, normal, SupportingPoint::Friction::none, {}};
  const dealii::Tensor<1, 3> tangential = traction - (traction * normal) * normal;
  const double size = tangential.norm();
  if (size > 0.)
    point.slip = -tangential / size;
  if (status == ContactStatus::slip) {
    if (size > 0.)
      point.friction = SupportingPoint::Friction::slips;
    return point;
  }
  point.friction = SupportingPoint::Friction::sticks;
  const double limit = friction.limit(std::max(0., traction * normal), 0.).value;
  point.use = limit > 0. ? size / limit : 0.;
  return point;
}
inline SupportingPoint make_supporting_point(const dealii::Tensor<1, 3> &position,
                                             const dealii::Tensor<1, 3> &normal, const Frictionless &,
                                             const ContactStatus, const dealii::Tensor<1, 3> &) {
  return {position, normal, SupportingPoint::Friction::none, {}};
}

} // namespace billet

#endif
