// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_COONS_PATCH_H
#define BILLET_GEOMETRY_COONS_PATCH_H

#include "billet/geometry/curve.h"
#include "billet/geometry/surface_patch.h"

#include <array>
#include <istream>
#include <string>

namespace billet {

/// Bilinearly blended surface spanned by four curves (Coons, MIT report MAC-TR-41, 1967). The
/// curves c_0, c_1 are at v = 0, 1, and d_0, d_1 at u = 0, 1. They meet in the corners P_ij at
/// u = i, v = j:
///   X(u, v) = (1 − v) c_0(u) + v c_1(u) + (1 − u) d_0(v) + u d_1(v)
///             − (1 − u)(1 − v) P_00 − u (1 − v) P_10 − (1 − u) v P_01 − u v P_11.
/// It contains the curves; its normal is along X_u × X_v.
class CoonsPatch final : public SurfacePatch {
public:
  using Point = dealii::Tensor<1, 3>;

  /// Makes a patch from curves that run around it, each starting at the end of the previous one:
  /// c_0, d_1, reversed c_1, reversed d_0. The order is counter-clockwise when seen against the
  /// normal. A side may degenerate to a point, but not two adjacent ones. Throws
  /// std::invalid_argument, with the reason, if the curves do not meet or the patch folds over,
  /// intersects itself or has no area.
  explicit CoonsPatch(const std::array<CurveSketch, 4> &round);

  ClosestPoint closest_point(const Point &x) const override;
  BoundingBox bounding_box() const override { return box_; }
  void draw(const OutputRegion &region, SurfaceMesh &surface_mesh) const override;

  /// Position and derivatives with respect to u and v.
  struct Jet {
    Point position, u, v, uu, uv, vv;
  };
  Jet at(double u, double v) const;

  /// Returns the unit normal at u, v, where `jet` was evaluated. Where X_u × X_v vanishes, as on a
  /// side that is a point, it is the limit from the middle of the patch. It is 0 if there is none.
  Point normal(const Jet &jet, double u, double v) const;

private:
  static constexpr std::size_t fewest_cells = 3, max_cells = 64; ///< along a side

  struct Range {
    double low_u, high_u, low_v, high_v;
  };
  /// Part of the patch that the search for closest points accepts or rejects as a whole.
  struct Cell {
    Range range;
    Jet middle;
    std::array<Point, 4> arms; ///< from the middle to the corners
    Point slack; ///< maximum deviation of the cell from its corners' bilinear surface, by component
    /// Upper bounds of |X_uu| + |X_uv| and |X_vv| + |X_uv|, in lengths instead of u and v.
    /// [1/length]
    double bend_u, bend_v;
    /// Upper bounds of the third derivatives |X_uuu|, |X_uuv|, |X_uvv|, |X_vvv|, likewise.
    /// [1/length²]
    double uuu, uuv, uvv, vvv;
  };
  struct Ball {
    Point centre;
    double radius;
  };
  struct Foot {
    double u, v;
    Jet jet;
    double square; ///< square of the distance
  };
  struct Step {
    double u, v;    ///< in lengths
    bool is_newton; ///< undamped, from a convex model
  };
  struct Block;

  void measure();
  void make_cells();
  Cell make_cell(unsigned int i, unsigned int j) const;
  void refuse_folds() const;     ///< throws where normals reverse
  void refuse_crossings() const; ///< throws where facets of the drawn size intersect

  Foot foot(const Point &x) const;
  bool may_be_nearer(std::size_t cell, const Point &arm, double square, double distance) const;
  bool is_nearest(const Foot &foot, const Point &x, const Block &block) const;
  Foot descend(const Point &x, Foot foot, const Range &range) const;
  Foot newton(const Point &x, Foot foot, const Range &range) const;
  Step newton_step(const Point &x, const Foot &foot, const Range &range, double damping) const;
  bool leave_pole(const Point &x, const Range &range, Foot &foot) const;
  dealii::Tensor<2, 3> turning(const Foot &foot, const Point &normal, double gap) const;

  std::vector<Curve> curves_;            ///< c_0, d_1, c_1, d_0
  std::array<bool, 4> is_pole_;          ///< whether the curve is a point
  std::array<Point, 4> corners_;         ///< P_00, P_10, P_11, P_01
  double size_ = 0.;                     ///< maximum distance of the curves' points from the first
  double length_u_ = 0., length_v_ = 0.; ///< means of |X_u|, |X_v|
  unsigned int n_u_ = 0, n_v_ = 0;       ///< number of cells
  std::vector<Cell> cells_;
  std::vector<Ball> balls_; ///< balls that contain the cells
  BoundingBox box_;
};

/// Reads the patches of a text file, one a line, which messages call `name`. Throws
/// std::invalid_argument if it has none, a line is none, or adjacent patches have opposite
/// orientations.
SurfacePatches read_coons_patches(std::istream &stream, const std::string &name);

} // namespace billet

#endif
