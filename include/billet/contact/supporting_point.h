// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SUPPORTING_POINT_H
#define BILLET_CONTACT_SUPPORTING_POINT_H

#include "billet/contact/traction.h"

#include <deal.II/base/tensor.h>

namespace billet {

/// A point of a body where contact has a stiffness.
struct SupportingPoint {
  /// What friction does there.
  enum class Friction {
    none,
    sticks, ///< resists every motion along the surface
    slips   ///< resists a motion across the slip, and one back, but none onwards
  };
  dealii::Tensor<1, 3> position; ///< [length]
  dealii::Tensor<1, 3> normal;   ///< unit, out of what is touched
  Friction friction = Friction::none;
  dealii::Tensor<1, 3> slip; ///< unit, of a point that slips: how the body slides on what it touches
};

/// The point at `position` with this traction on the body. Without tangential traction no slip has a
/// direction: such a point counts as frictionless.
inline SupportingPoint make_supporting_point(const dealii::Tensor<1, 3> &position,
                                             const dealii::Tensor<1, 3> &normal, const bool has_friction,
                                             const ContactStatus status,
                                             const dealii::Tensor<1, 3> &traction) {
  SupportingPoint point{position, normal, SupportingPoint::Friction::none, {}};
  if (!has_friction)
    return point;
  point.friction = SupportingPoint::Friction::sticks;
  if (status != ContactStatus::slip)
    return point;
  const dealii::Tensor<1, 3> tangential = traction - (traction * normal) * normal;
  const double size = tangential.norm();
  if (size > 0.) {
    point.friction = SupportingPoint::Friction::slips;
    point.slip = -tangential / size;
  } else
    point.friction = SupportingPoint::Friction::none;
  return point;
}

} // namespace billet

#endif
