// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/body_course.h"

#include "billet/errors.h"

#include <cmath>

namespace billet {

using dealii::Tensor;

BodyCourse::BodyCourse(const Scene &scene, const std::size_t body, const BodyReport &extent) {
  constexpr double rounding = 1e-12;
  const Body &of_scene = scene.bodies()[body];
  for (const Constraint &constraint : of_scene.constraints) {
    const bool is_known = constraint.value == nullptr || constraint.value->is_uniform();
    is_rigid_ = is_rigid_ && is_known;
    bool has_axis = false;
    for (unsigned int i = 0; i < 3 && !constraint.axes; ++i)
      if (std::abs(constraint.normal[i]) > 1. - rounding) {
        values_[i].push_back({is_known ? constraint.value : nullptr, constraint.normal[i]});
        has_axis = true;
      }
    if (constraint.value != nullptr && !has_axis)
      is_rigid_ = false;
  }
  if (scene.parameters().scheme().has_inertia)
    set_velocity(of_scene, extent);
  constexpr unsigned int n_samples = 20;
  for (unsigned int k = 0; k <= n_samples && is_rigid_; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      try {
        is_rigid_ = is_rigid_ && have_one_value(i, scene.parameters().time_stepping.end_time * k / n_samples);
      } catch (const SolutionFailure &) { // the run will report it
        is_rigid_ = false;
      }
}

Tensor<1, 3> BodyCourse::displacement(const double t) const {
  Tensor<1, 3> sum;
  for (unsigned int i = 0; i < 3; ++i)
    if (values_[i].empty())
      sum[i] = velocity_[i] * t;
    else if (have_one_value(i, t))
      sum[i] = value(values_[i].front(), t);
  return sum;
}

bool BodyCourse::have_one_value(const unsigned int component, const double t) const {
  constexpr double rounding = 1e-9;
  for (const Value &other : values_[component]) {
    const double first = value(values_[component].front(), t);
    if (std::abs(value(other, t) - first) > rounding * std::abs(first))
      return false;
  }
  return true;
}

void BodyCourse::set_velocity(const Body &body, const BodyReport &extent) {
  constexpr double rounding = 1e-9;
  const auto at = [&body](const unsigned int i, const Tensor<1, 3> &x) {
    return body.initial_velocity[i].value(0., dealii::Point<3>(x));
  };
  for (unsigned int i = 0; i < 3; ++i)
    try {
      const double velocity = at(i, 0.5 * (extent.low + extent.high));
      for (const Tensor<1, 3> &corner : {extent.low, extent.high})
        is_rigid_ = is_rigid_ && std::abs(at(i, corner) - velocity) <= rounding * std::abs(velocity);
      velocity_[i] = velocity;
    } catch (const SolutionFailure &) { // these points may lie outside the body
      is_rigid_ = false;
    }
}

std::vector<BodyCourse> find_courses(const Scene &scene, const std::vector<BodyReport> &bodies) {
  std::vector<BodyCourse> courses;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    courses.emplace_back(scene, b, bodies[b]);
  return courses;
}

} // namespace billet
