// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/tool.h"

#include "billet/errors.h"

#include <deal.II/base/point.h>
#include <deal.II/physics/transformations.h>

#include <sstream>

namespace billet {

Tool::Tool(const parameters::Tool &parameters, const std::vector<parameters::Amplitude> &amplitudes)
    : name_(parameters.name), shapes_(parameters.shapes), surface_(parameters.surface),
      angle_(parameters.motion.rotation_angle.value, Expression::Variables::time, amplitudes,
             parameters.motion.rotation_angle.origin),
      axis_(parameters.motion.rotation_axis), centre_(parameters.motion.centre),
      control_(parameters.motion.control), force_direction_(parameters.motion.direction),
      removal_time_(parameters.motion.removal_time.value), release_time_(parameters.motion.release_time) {
  if (control_ != Control::motion) {
    load_origin_ = parameters.motion.load.origin;
    load_ = std::make_unique<Expression>(parameters.motion.load.value, Expression::Variables::time,
                                         amplitudes, load_origin_);
  }
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

double Tool::load(const double t) const {
  const double load = load_->value(t);
  if (load < 0. && control_ != Control::moment) {
    std::ostringstream message;
    message << load_origin_ << " is " << load << " at time " << t
            << "; allowed are forces >= 0, since 'Force direction' sets the direction";
    throw SolutionFailure(message.str());
  }
  return load;
}

} // namespace billet
