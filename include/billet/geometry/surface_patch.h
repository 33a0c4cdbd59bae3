// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_SURFACE_PATCH_H
#define BILLET_GEOMETRY_SURFACE_PATCH_H

#include <deal.II/base/tensor.h>

#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace billet {

/// Axis-aligned box; sides may be infinite.
struct BoundingBox {
  dealii::Tensor<1, 3> low, high;

  /// Returns an empty box, the neutral element of add().
  static BoundingBox empty() {
    BoundingBox box;
    for (unsigned int i = 0; i < 3; ++i) {
      box.low[i] = std::numeric_limits<double>::infinity();
      box.high[i] = -box.low[i];
    }
    return box;
  }
  void add(const dealii::Tensor<1, 3> &point) {
    for (unsigned int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], point[i]);
      high[i] = std::max(high[i], point[i]);
    }
  }
  void add(const BoundingBox &other) {
    add(other.low);
    add(other.high);
  }
  void enlarge(const double distance) {
    for (unsigned int i = 0; i < 3; ++i) {
      low[i] -= distance;
      high[i] += distance;
    }
  }
  /// Returns the squared distance to the nearest point of the box.
  double distance_square(const dealii::Tensor<1, 3> &point) const {
    double sum = 0.;
    for (unsigned int i = 0; i < 3; ++i) {
      const double outside = std::max({low[i] - point[i], point[i] - high[i], 0.});
      sum += outside * outside;
    }
    return sum;
  }
  /// Whether the two have a point in common; an empty box has none.
  bool overlaps(const BoundingBox &other) const {
    bool all = true;
    for (unsigned int i = 0; i < 3; ++i)
      all = all && low[i] <= other.high[i] && other.low[i] <= high[i];
    return all;
  }
};

/// Triangles and quadrilaterals that represent a surface in field output, in the tool's own
/// coordinates.
struct SurfaceMesh {
  std::vector<dealii::Tensor<1, 3>> points;
  std::vector<std::vector<unsigned int>> facets;
};

/// Region that the output of a surface covers; infinite surfaces are cut off there.
struct OutputRegion {
  dealii::Tensor<1, 3> centre;
  double radius;
};

/// Returns κ/(1 + κ gap), the rotation of the normal with x along a principal direction of
/// curvature κ [1/length]. It is zero at the centre of curvature, such as the middle of a sphere:
/// there the normal is arbitrary and kept fixed.
inline double turned(const double curvature, const double gap) {
  const double part = 1. + curvature * gap;
  return std::abs(part) > 1e-9 ? curvature / part : 0.;
}

/// Point of a surface that is nearest to a point x.
struct ClosestPoint {
  dealii::Tensor<1, 3> position;
  dealii::Tensor<1, 3> normal; ///< unit vector, out of the tool
  double gap;                  ///< (x − position)·normal [length]
  /// ∂n/∂x, the second derivative of the gap: with the principal curvatures κ of the surface,
  /// positive where it is convex, Σ κ/(1 + κ gap) e⊗e. On the surface itself it is the curvature
  /// tensor [1/length]. It is always finite; see turned().
  dealii::Tensor<2, 3> turning;
  /// Whether x is not directly above the surface, but beyond its edge; the gap is then no distance.
  bool is_beyond_edge = false;
};

/// Piece of a rigid surface in the tool's own coordinates, trimmed to its range. It has no mesh and
/// no motion.
class SurfacePatch {
public:
  virtual ~SurfacePatch() = default;

  /// Returns the globally closest point, for any distance of `x`. If several are equally near
  /// (centre of a sphere, axis of a torus), the result is always the same one.
  virtual ClosestPoint closest_point(const dealii::Tensor<1, 3> &x) const = 0;

  /// Whether the whole patch is certainly farther from x than the root of `square`. This quick
  /// check saves a closest-point search; it returns false if the answer is expensive.
  virtual bool is_farther(const dealii::Tensor<1, 3> & /*x*/, const double /*square*/) const { return false; }

  /// Returns a box that contains the surface.
  virtual BoundingBox bounding_box() const = 0;

  /// Returns the maximum distance between its edge and that of an adjacent patch, due to round-off
  /// or the tolerance of its file [length].
  virtual double edge_accuracy() const { return 0.; }

  /// Adds facets to `surface_mesh`.
  virtual void draw(const OutputRegion &region, SurfaceMesh &surface_mesh) const = 0;
};

using SurfacePatches = std::vector<std::unique_ptr<const SurfacePatch>>;

/// Returns a single patch of type `Patch`, made from these arguments.
template <class Patch, class... Arguments> SurfacePatches single_patch(Arguments &&...arguments) {
  SurfacePatches patches;
  patches.push_back(std::make_unique<Patch>(std::forward<Arguments>(arguments)...));
  return patches;
}

} // namespace billet

#endif
