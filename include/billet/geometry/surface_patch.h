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

/// Axis-parallel box; sides may be infinite.
struct BoundingBox {
  dealii::Tensor<1, 3> low, high;

  /// Empty: adding to it makes it what was added.
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
  /// Square of the distance to the nearest point of the box.
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

/// Triangles and quadrilaterals that picture a surface, in the tool's own coordinates.
struct SurfacePicture {
  std::vector<dealii::Tensor<1, 3>> points;
  std::vector<std::vector<unsigned int>> facets;
};

/// Region that a picture has to cover: what is infinite is cut off there.
struct PictureRegion {
  dealii::Tensor<1, 3> centre;
  double radius;
};

/// κ/(1 + κ gap), how the normal turns with x along a principal direction of curvature κ [1/length]. Zero in
/// the centre of curvature, such as the middle of a sphere: there all normals around are as good, and the one
/// that was chosen stays.
inline double turned(const double curvature, const double gap) {
  const double part = 1. + curvature * gap;
  return std::abs(part) > 1e-9 ? curvature / part : 0.;
}

/// The point of a surface that is nearest to a point x.
struct ClosestPoint {
  dealii::Tensor<1, 3> position;
  dealii::Tensor<1, 3> normal; ///< unit, out of the tool
  double gap;                  ///< (x − position)·normal [length]
  /// ∂n/∂x, the second derivative of the gap: with the principal curvatures κ of the surface, positive where
  /// it is convex, Σ κ/(1 + κ gap) e⊗e. On the surface itself it is the curvature tensor [1/length]. Always
  /// finite; see turned().
  dealii::Tensor<2, 3> turning;
  /// x is not straight above the surface, but beyond its border; the gap is then no distance.
  bool is_beyond_border = false;
};

/// One piece of a rigid surface in the tool's own coordinates, trimmed to its range. Pure: no mesh, no
/// motion.
class SurfacePatch {
public:
  virtual ~SurfacePatch() = default;

  /// The true closest point, however far `x` is. Where several are as near (the centre of a sphere, the axis
  /// of a torus), always the same one of them.
  virtual ClosestPoint closest_point(const dealii::Tensor<1, 3> &x) const = 0;

  /// Whether the whole patch is surely farther from x than the root of `square`: something quick to spare a
  /// closest point; false if that takes long to tell.
  virtual bool is_farther(const dealii::Tensor<1, 3> & /*x*/, const double /*square*/) const { return false; }

  /// Contains the surface.
  virtual BoundingBox bounding_box() const = 0;

  /// How far its border may be from that of a neighbour that it meets, by rounding or by what its file allows
  /// itself [length].
  virtual double border_accuracy() const { return 0.; }

  /// Adds facets to the picture.
  virtual void draw(const PictureRegion &region, SurfacePicture &picture) const = 0;
};

using SurfacePatches = std::vector<std::unique_ptr<const SurfacePatch>>;

/// A patch of type `Patch`, made of these arguments, and no other.
template <class Patch, class... Arguments> SurfacePatches single_patch(Arguments &&...arguments) {
  SurfacePatches patches;
  patches.push_back(std::make_unique<Patch>(std::forward<Arguments>(arguments)...));
  return patches;
}

} // namespace billet

#endif
