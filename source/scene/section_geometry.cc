// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/section_geometry.h"

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/physics/transformations.h>

#include <cmath>

namespace billet {

using dealii::Tensor;

SectionGeometry::SectionGeometry(const parameters::Mesh &mesh)
    : is_turned_(mesh.section.value == parameters::Mesh::Section::axisymmetric),
      direction_(mesh.rotated(Tensor<1, 3>({0., 0., 1.}))), radial_(mesh.rotated(Tensor<1, 3>({1., 0., 0.}))),
      circumference_(mesh.rotated(Tensor<1, 3>({0., 1., 0.}))), origin_(mesh.translation),
      width_(mesh.scale * mesh.height), angle_(mesh.wedge_angle) {}

Tensor<1, 3> SectionGeometry::circumference(const Tensor<1, 3> &x) const {
  const Tensor<1, 3> r = arm(x);
  return r.norm() > 0. ? dealii::cross_product_3d(direction_, r) / r.norm() : circumference_;
}

Tensor<2, 3> SectionGeometry::turn(const double angle) const {
  return dealii::Physics::Transformations::Rotations::rotation_matrix_3d(direction_, angle);
}

Tensor<1, 3> SectionGeometry::turned(const Tensor<1, 3> &x, const double angle) const {
  return origin_ + turn(angle) * (x - origin_);
}

Tensor<2, 3> SectionGeometry::turn_to(const Tensor<1, 3> &x) const {
  const Tensor<1, 3> r = arm(x);
  return std::atan2(r * circumference_, r * radial_) > 0.5 * angle_
             ? turn(angle_)
             : Tensor<2, 3>(dealii::unit_symmetric_tensor<3>());
}

std::vector<Tensor<1, 3>> SectionGeometry::places(const Tensor<1, 3> &x) const {
  constexpr unsigned int n = 8;
  // Multiples of the golden angle come near to each other, or to parts of the circle, later than
  // all others.
  const double golden = M_PI * (3. - std::sqrt(5.));
  std::vector<Tensor<1, 3>> result = {x};
  const double height = (x - origin_) * direction_;
  for (unsigned int i = 1; i < n; ++i)
    result.push_back(is_turned_
                         ? turned(x, i * golden)
                         : x + (width_ * std::fmod(0.5 * i * golden / M_PI, 1.) - height) * direction_);
  if (!is_turned_)
    for (const double part : {0., 0.5, 1.})
      result.push_back(x + (part * width_ - height) * direction_);
  return result;
}

} // namespace billet
