// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_RIGID_SURFACE_H
#define BILLET_GEOMETRY_RIGID_SURFACE_H

#include "billet/geometry/box_tree.h"

#include <memory>

namespace billet {

/// Maximum gap at which a node touches a tool, relative to the size of the facets around it.
constexpr double touching_gap = 1e-9;

/// Surface of a rigid tool in the tool's own coordinates: a set of patches, of which the nearest
/// determines contact. The surface continues where patches meet. Smooth seams have no effect. In a
/// concave edge the gap is the distance to the edge. Beyond a free edge, which no other patch
/// shares, there is no surface.
class RigidSurface {
public:
  explicit RigidSurface(SurfacePatches patches);

  struct Projection {
    bool exists; ///< whether the point projects onto the surface; otherwise only the gap is set
    dealii::Tensor<1, 3> normal; ///< unit vector, out of the tool, at the contact point
    double gap; ///< (x − x_P)·n, positive outside; without contact point, the distance [length]
    dealii::Tensor<2, 3> turning; ///< ∂n/∂x [1/length]
    unsigned int patch;           ///< nearest patch, the first guess for the next search
    /// If the projection does not exist: distance of the point beyond the edge, along the tangent
    /// plane there [length].
    double beyond = 0.;
    bool is_behind = false; ///< likewise: whether the point is on the inner side of that plane
  };

  /// Returns the contact point of `x` (Bittencourt & Creus 1998, eqs. (7)-(15)). `first_patch`, a
  /// guess of the nearest patch, affects the cost but not the result.
  Projection project(const dealii::Tensor<1, 3> &x, unsigned int first_patch = 0) const;

  /// Geometry of the surface's edge near a point beyond it: the nearest point x_b of the edge, and
  /// the surface's normal n there.
  struct EdgePoint {
    dealii::Tensor<1, 3> normal;  ///< n
    double gap;                   ///< g = (x − x_b)·n [length]
    dealii::Tensor<2, 3> turning; ///< ∂n/∂x, along the edge [1/length]
    double beyond;                ///< d = |x − x_b − g n| > 0 [length]
    dealii::Tensor<1, 3> outward; ///< e = ∂d/∂x
    /// ∂e/∂x: 0 at a straight edge, 1/d in the fan of a corner [1/length].
    dealii::Tensor<2, 3> spreading;
  };
  /// Returns the edge data of a point whose projection does not exist. `patch` is that of the
  /// projection, `width` the maximum relevant distance beyond the edge [length]. The torsion of
  /// edges is neglected.
  EdgePoint edge_point(const dealii::Tensor<1, 3> &x, unsigned int patch, double width) const;

  const BoundingBox &bounding_box() const { return box_; }
  SurfaceMesh surface_mesh(const OutputRegion &region) const;

private:
  /// Patches that meet in the nearest point, including the nearest patch itself.
  struct Neighbours {
    std::vector<dealii::Tensor<1, 3>> normals;
    dealii::Tensor<1, 3> mean;    ///< mean of the normals, unit vector
    dealii::Tensor<2, 3> turning; ///< mean
    double sharpness = 0.;        ///< maximum sine of an angle with the nearest patch's normal
    unsigned int sharpest = 0;    ///< patch with that angle
    dealii::Tensor<1, 3> sharpest_normal;
    dealii::Tensor<1, 3> edge; ///< direction of the edge between the two
    bool is_straight_below = false;
    Projection below{}; ///< on a patch that ends there, but extends below x
  };
  Neighbours find_neighbours(const dealii::Tensor<1, 3> &x, const ClosestPoint &nearest,
                             unsigned int patch) const;
  Projection project_beyond_edge(const dealii::Tensor<1, 3> &x, const ClosestPoint &nearest,
                                 unsigned int patch) const;
  /// Returns e·∂n/∂x·e near the edge along e between two patches, minus the value 1/gap of a point.
  double turning_along_edge(const Projection &projection, const ClosestPoint &nearest, unsigned int patch,
                            const Neighbours &around) const;

  SurfacePatches patches_;
  BoxTree tree_;
  BoundingBox box_;
  double tolerance_ = 0.; ///< maximum distance between patches that meet [length]
};

} // namespace billet

#endif
