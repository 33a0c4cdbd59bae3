// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_BODY_COURSE_H
#define BILLET_RUN_BODY_COURSE_H

#include "billet/run/scene_report.h"
#include "billet/scene/scene.h"

#include <array>
#include <vector>

namespace billet {

/// Translation of a body by its supports and its initial velocity.
class BodyCourse {
public:
  /// `extent`: report of the body, for its box.
  BodyCourse(const Scene &scene, std::size_t body, const BodyReport &extent);

  /// Returns the displacement. Where supports deform the body, it counts as 0. Throws
  /// SolutionFailure if a value is undefined.
  dealii::Tensor<1, 3> displacement(double t) const;
  /// Returns the initial velocity; 0 in static scenes [length/time].
  const dealii::Tensor<1, 3> &initial_velocity() const { return velocity_; }
  /// Whether supports and velocities move the body without deformation, as far as known.
  bool is_rigid() const { return is_rigid_; }

private:
  struct Value {
    const Expression *expression; ///< null: 0
    double sign;
  };

  static double value(const Value &of, const double t) {
    return of.expression != nullptr ? of.sign * of.expression->value(t) : 0.;
  }
  bool have_one_value(unsigned int component, double t) const;
  void set_velocity(const Body &body, const BodyReport &extent);

  std::array<std::vector<Value>, 3> values_; ///< of the supports, by component
  dealii::Tensor<1, 3> velocity_;
  bool is_rigid_ = true;
};

/// Returns the courses of all bodies.
std::vector<BodyCourse> find_courses(const Scene &scene, const std::vector<BodyReport> &bodies);

} // namespace billet

#endif
