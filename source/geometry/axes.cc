// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/axes.h"

#include "billet/geometry/frame.h"

#include <sstream>

namespace billet {

using dealii::Tensor;

std::vector<TypeParameter> Axes::parameters() {
  using Kind = TypeParameter::Kind;
  return {{"Axes", "global", Kind::choice,
           "global|local|cylindrical: Axes of the components. global: x, y, z. local: a fixed triad of "
           "'First axis' and 'Second axis'. cylindrical: radius, circumference and axis at the undeformed "
           "position, about the line of 'Axis point' and 'Axis direction'."},
          {"First axis", "", Kind::text, "Local axes: vector 'x, y, z' of any length along the first axis."},
          {"Second axis", "", Kind::text,
           "Local axes: vector 'x, y, z'. Its part across the first axis is along the second one. The third "
           "one follows by the right-hand rule."},
          {"Axis point", "", Kind::text,
           "Cylindrical axes: point 'x, y, z' of the line. Empty: the origin. [length]"},
          {"Axis direction", "", Kind::text,
           "Cylindrical axes: vector 'x, y, z' along the line, about which the circumference turns by the "
           "right-hand rule."}};
}

Axes::Axes(const TypeInput &input) {
  const std::string kind = input.text("Axes");
  kind_ = kind == "local" ? Kind::local : kind == "cylindrical" ? Kind::cylindrical : Kind::global;
  for (const std::string key : {"First axis", "Second axis"})
    if (input.is_set(key) && kind_ != Kind::local)
      input.reject(key, "no value: 'Axes' is " + kind);
  for (const std::string key : {"Axis point", "Axis direction"})
    if (input.is_set(key) && kind_ != Kind::cylindrical)
      input.reject(key, "no value: 'Axes' is " + kind);
  if (kind_ == Kind::local) {
    triad_[0] = input.direction("First axis");
    triad_[1] = input.direction("Second axis");
    triad_[1] -= (triad_[1] * triad_[0]) * triad_[0];
    constexpr double parallel = 1e-6;
    if (triad_[1].norm() < parallel)
      input.reject("Second axis", "a vector that is not parallel to 'First axis'");
    triad_[1] /= triad_[1].norm();
    triad_[2] = dealii::cross_product_3d(triad_[0], triad_[1]);
  }
  if (kind_ == Kind::cylindrical) {
    if (!input.is_set("Axis direction"))
      input.reject("Axis direction",
                   "a vector 'x, y, z' along the line about which the axes are cylindrical");
    if (input.is_set("Axis point"))
      point_ = input.vector("Axis point");
    triad_[2] = input.direction("Axis direction");
  }
}

Axes::Axes(const std::array<Tensor<1, 3>, 3> &triad) : kind_(Kind::local), triad_(triad) {}

Axes Axes::about(const Tensor<1, 3> &point, const Tensor<1, 3> &direction) {
  Axes axes;
  axes.kind_ = Kind::cylindrical;
  axes.point_ = point;
  axes.triad_[2] = direction;
  return axes;
}

std::string Axes::description() const {
  std::ostringstream text;
  text.precision(6);
  const auto write = [&](const Tensor<1, 3> &vector) {
    text << "(" << vector[0] << ", " << vector[1] << ", " << vector[2] << ")";
  };
  if (kind_ == Kind::local) {
    text << "axes ";
    write(triad_[0]);
    text << ", ";
    write(triad_[1]);
  } else if (kind_ == Kind::global) {
    text << "axes x, y, z";
  } else {
    text << "cylindrical axes about the line through ";
    write(point_);
    text << " along ";
    write(triad_[2]);
  }
  return text.str();
}

double Axes::radius(const Tensor<1, 3> &position) const {
  const Tensor<1, 3> arm = position - point_;
  return (arm - (arm * triad_[2]) * triad_[2]).norm();
}

std::array<Tensor<1, 3>, 3> Axes::at(const Tensor<1, 3> &position) const {
  if (kind_ == Kind::global)
    return {Tensor<1, 3>({1., 0., 0.}), Tensor<1, 3>({0., 1., 0.}), Tensor<1, 3>({0., 0., 1.})};
  if (kind_ == Kind::local)
    return triad_;
  const Tensor<1, 3> &axis = triad_[2];
  Tensor<1, 3> radial = position - point_;
  radial -= (radial * axis) * axis;
  radial = radial.norm() > 0. ? radial / radial.norm() : Frame::from_normal(axis).q;
  return {radial, dealii::cross_product_3d(axis, radial), axis};
}

Tensor<1, 3> Axes::to_global(const double *components, const Tensor<1, 3> &position) const {
  if (kind_ == Kind::global)
    return Tensor<1, 3>({components[0], components[1], components[2]});
  const auto axes = at(position);
  return components[0] * axes[0] + components[1] * axes[1] + components[2] * axes[2];
}

Tensor<1, 3> Axes::from_global(const Tensor<1, 3> &vector, const Tensor<1, 3> &position) const {
  if (kind_ == Kind::global)
    return vector;
  const auto axes = at(position);
  return Tensor<1, 3>({axes[0] * vector, axes[1] * vector, axes[2] * vector});
}

dealii::SymmetricTensor<2, 3> Axes::from_global(const dealii::SymmetricTensor<2, 3> &tensor,
                                                const Tensor<1, 3> &position) const {
  if (kind_ == Kind::global)
    return tensor;
  const auto axes = at(position);
  dealii::SymmetricTensor<2, 3> components;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = i; j < 3; ++j)
      components[i][j] = axes[i] * (tensor * axes[j]);
  return components;
}

} // namespace billet
