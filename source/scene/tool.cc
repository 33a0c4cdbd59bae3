// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/tool.h"

#include <deal.II/base/point.h>
#include <deal.II/physics/transformations.h>

namespace billet {

Tool::Tool(const parameters::Tool &parameters, const std::vector<parameters::Amplitude> &amplitudes)
    : name_(parameters.name), shapes_(parameters.shapes), surface_(parameters.surface),
      angle_(parameters.motion.rotation_angle.value, Expression::Variables::time, amplitudes,
             parameters.motion.rotation_angle.origin),
      axis_(parameters.motion.rotation_axis), centre_(parameters.motion.centre),
      control_(parameters.motion.control), force_direction_(parameters.motion.direction),
      removal_time_(parameters.motion.removal_time.value), release_time_(parameters.motion.release_time) {
  if (control_ != Control::motion)
    load_ = std::make_unique<Expression>(parameters.motion.load.value, Expression::Variables::time,
                                         amplitudes, parameters.motion.load.origin);
  for (const auto &component : parameters.motion.translation.value)
    translation_.emplace_back(component, Expression::Variables::time, amplitudes,
                              parameters.motion.translation.origin);
}

Placement Tool::placement(const double t, const double offset) const {
  Placement placement;
  for (unsigned int i = 0; i < 3; ++i)
    placement.translation[i] = translation_[i].value(t);
  placement.rotation_angle = angle_.value(t);
  if (control_ == Control::moment)
    placement.rotation_angle += offset;
  else
    placement.translation += offset * force_direction_;
  placement.rotation =
      dealii::Physics::Transformations::Rotations::rotation_matrix_3d(axis_, placement.rotation_angle);
  placement.centre = centre_;
  return placement;
}

} // namespace billet
