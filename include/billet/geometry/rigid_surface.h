// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_RIGID_SURFACE_H
#define BILLET_GEOMETRY_RIGID_SURFACE_H

#include <deal.II/base/tensor.h>

#include <array>
#include <vector>

namespace billet {

/// Triangles and quadrilaterals that picture a surface, in the tool's own coordinates.
struct SurfacePicture {
  std::vector<dealii::Tensor<1, 3>> points;
  std::vector<std::vector<unsigned int>> facets;
};

/// Surface of a rigid tool in the tool's own coordinates. Pure: no mesh, no motion.
class RigidSurface {
public:
  virtual ~RigidSurface() = default;

  struct Projection {
    dealii::Tensor<1, 3> normal; ///< unit, out of the tool, at the contact point
    double gap;                  ///< (x − x_P)·n, positive where the point is outside [length]
  };

  /// The contact point of `x` (Bittencourt & Creus 1998, eqs. (7)-(15)).
  virtual Projection project(const dealii::Tensor<1, 3> &x) const = 0;

  /// A picture of the part near the ball about `centre` [length].
  virtual SurfacePicture picture(const dealii::Tensor<1, 3> &centre, double radius) const = 0;
};

} // namespace billet

#endif
