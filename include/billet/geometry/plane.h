// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_PLANE_H
#define BILLET_GEOMETRY_PLANE_H

#include "billet/geometry/surface_patch.h"

namespace billet {

/// Infinite plane: g = (x − x_I)·n, eq. (13).
class Plane final : public SurfacePatch {
public:
  /// `normal` has unit length and points out of the tool.
  Plane(const dealii::Tensor<1, 3> &point, const dealii::Tensor<1, 3> &normal)
      : point_(point), normal_(normal) {}

  ClosestPoint closest_point(const dealii::Tensor<1, 3> &x) const override {
    const double gap = (x - point_) * normal_;
    return {x - gap * normal_, normal_, gap, {}};
  }
  BoundingBox bounding_box() const override;
  void draw(const OutputRegion &region, SurfaceMesh &surface_mesh) const override;

private:
  dealii::Tensor<1, 3> point_, normal_;
};

} // namespace billet

#endif
