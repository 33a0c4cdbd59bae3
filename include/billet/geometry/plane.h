// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_PLANE_H
#define BILLET_GEOMETRY_PLANE_H

#include "billet/geometry/rigid_surface.h"

namespace billet {

/// Infinite plane: g = (x − x_I)·n, eq. (13).
class Plane final : public RigidSurface {
public:
  /// `normal` has unit length and points out of the tool.
  Plane(const dealii::Tensor<1, 3> &point, const dealii::Tensor<1, 3> &normal)
      : point_(point), normal_(normal) {}

  Projection project(const dealii::Tensor<1, 3> &x) const override {
    return {normal_, (x - point_) * normal_};
  }

  SurfacePicture picture(const dealii::Tensor<1, 3> &centre, double radius) const override;

private:
  dealii::Tensor<1, 3> point_, normal_;
};

} // namespace billet

#endif
