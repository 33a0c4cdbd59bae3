// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_SECTION_GEOMETRY_H
#define BILLET_SCENE_SECTION_GEOMETRY_H

#include "billet/parameters/body.h"

#include <vector>

namespace billet {

/// Where a plane-strain or axisymmetric section is in space: the layer and its width, or the wedge
/// and its axis.
class SectionGeometry {
public:
  explicit SectionGeometry(const parameters::Mesh &mesh);

  /// Whether it is a wedge.
  bool is_turned() const { return is_turned_; }
  /// Returns the unit vector along the width of the layer, or along the axis of the wedge.
  const dealii::Tensor<1, 3> &direction() const { return direction_; }
  /// Returns the unit vector along the circumference at the first side of the wedge, where the
  /// section is.
  const dealii::Tensor<1, 3> &circumference() const { return circumference_; }
  /// Returns the wedge's angle [rad].
  double angle() const { return angle_; }
  /// Returns the distance from the axis [length].
  double radius(const dealii::Tensor<1, 3> &x) const { return arm(x).norm(); }
  /// Returns the length that differences are compared with: the radius, or the width.
  double length(const dealii::Tensor<1, 3> &x) const { return is_turned_ ? radius(x) : width_; }
  /// Returns the unit vector along the circumference at a point; that of the section on the axis.
  dealii::Tensor<1, 3> circumference(const dealii::Tensor<1, 3> &x) const;
  /// Returns the rotation about the axis by an angle [rad].
  dealii::Tensor<2, 3> turn(double angle) const;
  /// Returns a point turned about the axis.
  dealii::Tensor<1, 3> turned(const dealii::Tensor<1, 3> &x, double angle) const;
  /// Returns the rotation that takes the section to the side of the wedge that is nearer to a
  /// point.
  dealii::Tensor<2, 3> turn_to(const dealii::Tensor<1, 3> &x) const;
  /// Returns what is across the direction of a vector.
  dealii::Tensor<1, 3> across(const dealii::Tensor<1, 3> &v) const {
    return v - (v * direction_) * direction_;
  }
  /// Returns points that stand for the same point of the section in the solid, `x` first. Around
  /// the axis they are at angles that no symmetry of few axes repeats. Along the width of the layer
  /// they are on both sides and between.
  std::vector<dealii::Tensor<1, 3>> places(const dealii::Tensor<1, 3> &x) const;

private:
  dealii::Tensor<1, 3> arm(const dealii::Tensor<1, 3> &x) const { return across(x - origin_); }

  bool is_turned_;
  dealii::Tensor<1, 3> direction_, radial_, circumference_, origin_;
  double width_, angle_;
};

} // namespace billet

#endif
