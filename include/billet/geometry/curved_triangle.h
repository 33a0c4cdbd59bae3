// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_CURVED_TRIANGLE_H
#define BILLET_GEOMETRY_CURVED_TRIANGLE_H

#include "billet/geometry/parametric_surface.h"

#include <array>

namespace billet {

/// Triangle over three corners P_i whose edges are parabolas. It is the quadratic patch of Nagata
/// (2005), plus a term that rotates the normals along the edges without moving the edges. On u, v,
/// w = 1 − u − v ≥ 0
///   p = w P_0 + u P_1 + v P_2 − w u c_01 − u v c_12 − v w c_20 + F a,
///   F = w u v (w u l_01 + u v l_12 + v w l_20)/(w u + u v + v w),   a = (P_1 − P_0) × (P_2 − P_0).
/// Here c_ij, the bend of the edge between P_i and P_j, is half of its second derivative. The
/// function l_ij = α + β (λ_j − λ_i) is linear, with the weights λ of the corners.
///
/// F is 0 on the edges. Its derivative across an edge, towards the opposite corner, is λ_i λ_j l_ij
/// there and does not depend on the other two.
class CurvedTriangle {
public:
  using Point = dealii::Tensor<1, 3>;

  /// Coefficients α and β of an edge [1/length].
  struct Seam {
    float alpha = 0.F, beta = 0.F;
  };
  /// Bounds for a triangle that the search for closest points needs.
  struct Shape {
    /// Minimum of p,i·p,j − (x − p)·p,ij over the triangle for an x at the centroid, relative to
    /// the metric there. It measures how far the squared distance is from having several minima. 1
    /// if flat.
    float convexity = 0.F;
    /// Maximum second derivative of F, relative to this metric.
    float roughness = 0.F;
  };

  /// `bends`[i] and `seams`[i] belong to the edge from corner i to the next one. [length, 1/length]
  CurvedTriangle(const std::array<Point, 3> &corners, const std::array<Point, 3> &bends,
                 const std::array<Seam, 3> &seams);

  Point position(double u, double v) const { return point_at(u, v).p; }
  /// Returns p,u × p,v; its norm is twice the area [length²].
  Point area_normal(double u, double v) const;
  /// Returns the point with its derivatives.
  SurfacePoint point_at(double u, double v) const;

  Shape shape() const;

  /// Returns the closest point. `shape` is the result of shape(). If it does not guarantee a single
  /// minimum of the distance, the result is the nearest minimum found from a grid of starting
  /// points.
  ClosestPoint closest_point(const Point &x, const Shape &shape) const;

  /// Whether the control points, and so the triangle, are farther from x than the root of `square`,
  /// measured along the direction to the centroid.
  bool is_farther(const Point &x, double square) const;

  /// Returns a box around the control points, and so around the triangle.
  BoundingBox bounding_box() const;

private:
  /// Symmetric 2 × 2 matrix.
  struct Matrix {
    double uu, uv, vv;
    double along(const double u, const double v) const { return u * u * uu + 2. * u * v * uv + v * v * vv; }
  };
  static double determinant(const Matrix &m) { return m.uu * m.vv - m.uv * m.uv; }
  /// Point of the triangle. at[i]: it lies on the edge opposite to corner i.
  struct Iterate {
    double u, v;
    std::array<bool, 3> at;
    SurfacePoint point;
    Point arm;     ///< x − p
    double square; ///< square of its length
  };
  struct Step {
    double u = 0., v = 0.;
    double slope = 0.; ///< slope of half the squared distance, negative
    /// The step is along the edge opposite to this corner; 3: not along an edge.
    unsigned int along = 3;
    bool is_newton = true;   ///< otherwise the curvature is neglected
    bool is_possible = true; ///< otherwise the iterate is a corner that is a minimum
  };

  SurfacePoint quadratic_point_at(double u, double v) const;
  Iterate at(const Point &x, double u, double v, const std::array<bool, 3> &at) const;
  Iterate start_below(const Point &x) const;
  static Step choose_step(const Iterate &here);
  Iterate descend(const Point &x, Iterate here) const;
  Iterate at_edge(const Point &x, unsigned int i, double t) const;
  Iterate nearest_on_edge(const Point &x, unsigned int i) const;
  Iterate descend_once(const Point &x) const;
  Iterate descend_from_all(const Point &x) const;
  double max_turning_part() const;
  bool has_one_minimum(const Point &x, const Shape &shape) const;
  static Matrix metric(const SurfacePoint &point) {
    return {point.p_u * point.p_u, point.p_u * point.p_v, point.p_v * point.p_v};
  }
  static Matrix bending(const Point &a, const SurfacePoint &point) {
    return {a * point.p_uu, a * point.p_uv, a * point.p_vv};
  }

  /// p = origin + u_ u + v_ v + uu_ u² + uv_ u v + vv_ v² + F up_.
  Point origin_, u_, v_, uu_, uv_, vv_;
  Point up_;
  std::array<Seam, 3> seams_;
  bool has_seams_ = false;
};

} // namespace billet

#endif
