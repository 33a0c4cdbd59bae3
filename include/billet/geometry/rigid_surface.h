// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_RIGID_SURFACE_H
#define BILLET_GEOMETRY_RIGID_SURFACE_H

#include "billet/geometry/box_tree.h"

#include <memory>

namespace billet {

/// A node that is no farther from a tool than this part of the facets around it touches it.
constexpr double touching_gap = 1e-9;

/// The surface of a rigid tool in the tool's own coordinates: patches, of which the nearest counts. Where
/// patches meet the surface goes on: on a smooth seam nothing shows; in a concave edge the gap is the
/// distance to the edge; beyond a border that no other patch shares there is no surface.
class RigidSurface {
public:
  explicit RigidSurface(SurfacePatches patches);

  struct Projection {
    bool exists;                 ///< whether the surface lies before the point; else only the gap is set
    dealii::Tensor<1, 3> normal; ///< unit, out of the tool, at the contact point
    double gap; ///< (x − x_P)·n, positive outside; without contact point, the distance [length]
    dealii::Tensor<2, 3> turning; ///< ∂n/∂x [1/length]
    unsigned int patch;           ///< the nearest, to start from the next time
    /// Where the surface does not lie before the point: how far, along its tangent plane at the border, the
    /// point is beyond that [length].
    double beyond = 0.;
    bool is_behind = false; ///< and on the inner side of that plane
  };

  /// The contact point of `x` (Bittencourt & Creus 1998, eqs. (7)-(15)). The answer does not depend on
  /// `first_patch`, a guess of the nearest one; the cost does.
  Projection project(const dealii::Tensor<1, 3> &x, unsigned int first_patch = 0) const;

  /// How the surface ends beside a point beyond its border: the nearest point x_b of the border, and the
  /// surface's normal n there.
  struct Border {
    dealii::Tensor<1, 3> normal;    ///< n
    double gap;                     ///< g = (x − x_b)·n [length]
    dealii::Tensor<2, 3> turning;   ///< ∂n/∂x, along the border [1/length]
    double beyond;                  ///< d = |x − x_b − g n| > 0 [length]
    dealii::Tensor<1, 3> outward;   ///< e = ∂d/∂x
    dealii::Tensor<2, 3> spreading; ///< ∂e/∂x: 0 at a straight border, of a corner's fan 1/d [1/length]
  };
  /// Of a point whose projection does not exist; `patch` is that projection's, `width` how far beyond the
  /// border it matters. Borders with torsion are taken as if they had none.
  Border border(const dealii::Tensor<1, 3> &x, unsigned int patch, double width) const;

  std::size_t n_patches() const { return patches_.size(); }
  const BoundingBox &bounding_box() const { return box_; }
  SurfacePicture picture(const PictureRegion &region) const;

private:
  /// The patches that meet in the nearest point, itself among them.
  struct Neighbours {
    std::vector<dealii::Tensor<1, 3>> normals;
    dealii::Tensor<1, 3> mean;    ///< of the normals, unit
    dealii::Tensor<2, 3> turning; ///< mean
    double sharpness = 0.;        ///< largest sine of an angle with the nearest patch's normal
    unsigned int sharpest = 0;    ///< the patch that it belongs to
    dealii::Tensor<1, 3> sharpest_normal;
    dealii::Tensor<1, 3> edge; ///< direction of the edge between the two
    bool is_straight_below = false;
    Projection below{}; ///< on a patch that ends there, but not short of x
  };
  Neighbours find_neighbours(const dealii::Tensor<1, 3> &x, const ClosestPoint &nearest,
                             unsigned int patch) const;
  Projection project_beyond_border(const dealii::Tensor<1, 3> &x, const ClosestPoint &nearest,
                                   unsigned int patch) const;
  /// e·∂n/∂x·e beside the edge along e between two patches, less that of a point, 1/gap.
  double turning_along_edge(const Projection &projection, const ClosestPoint &nearest, unsigned int patch,
                            const Neighbours &around) const;

  SurfacePatches patches_;
  BoxTree tree_;
  BoundingBox box_;
  double tolerance_ = 0.; ///< patches that come nearer than this to each other meet [length]
};

} // namespace billet

#endif
