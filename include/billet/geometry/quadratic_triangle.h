// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_QUADRATIC_TRIANGLE_H
#define BILLET_GEOMETRY_QUADRATIC_TRIANGLE_H

#include "billet/geometry/surface_patch.h"

#include <array>

namespace billet {

/// A triangle over three corners P_i whose edges are parabolas, the quadratic patch of Nagata (2005): on
/// u, v, w = 1 − u − v ≥ 0
///   p = w P_0 + u P_1 + v P_2 − w u c_01 − u v c_12 − v w c_20
/// where c_ij is the bend of the edge between P_i and P_j, half of its second derivative.
class QuadraticTriangle {
public:
  using Point = dealii::Tensor<1, 3>;

  /// bends[i]: of the edge from corner i to the next one [length].
  QuadraticTriangle(const std::array<Point, 3> &corners, const std::array<Point, 3> &bends);

  Point position(const double u, const double v) const {
    return origin_ + u * (u_ + u * uu_ + v * uv_) + v * (v_ + v * vv_);
  }
  /// p,u × p,v, as long as twice the area [length²].
  Point area_normal(double u, double v) const;

  /// The part of the metric at the centroid that is left of p,i·p,j − (x − p)·p,ij anywhere in the triangle
  /// for an x at the centroid: how far the squared distance is from having several minima. 1 if flat.
  double convexity() const;

  /// The true closest point; where `convexity`, what convexity() said, does not promise a single minimum of
  /// the distance, the nearest of those that are found from a grid of starting points.
  ClosestPoint closest_point(const Point &x, double convexity) const;

  /// Whether the control points, and so the triangle, are farther from x than the root of `square` even along
  /// the direction to the centroid.
  bool is_farther(const Point &x, double square) const;

  /// Holds the control points, and so the triangle.
  BoundingBox bounding_box() const;

private:
  /// A symmetric 2 × 2 matrix.
  struct Matrix {
    double uu, uv, vv;
    double along(const double u, const double v) const { return u * u * uu + 2. * u * v * uv + v * v * vv; }
  };
  static double determinant(const Matrix &m) { return m.uu * m.vv - m.uv * m.uv; }
  /// A point of the triangle. at[i]: it lies on the edge opposite to corner i.
  struct Iterate {
    double u, v;
    std::array<bool, 3> at;
    Point arm, p_u, p_v; ///< x − p and the derivatives of p
    double square;       ///< of the arm
  };
  struct Step {
    double u = 0., v = 0.;
    double slope = 0.;       ///< of half the squared distance, negative
    unsigned int along = 3;  ///< the edge opposite to this corner, or 3: not along an edge
    bool is_newton = true;   ///< else the curvature was left out
    bool is_possible = true; ///< else the iterate is a corner that is a minimum
  };

  Iterate at(const Point &x, double u, double v, const std::array<bool, 3> &at) const;
  Iterate start_below(const Point &x) const;
  Step choose_step(const Iterate &here) const;
  Iterate descend(const Point &x, Iterate here) const;
  Iterate at_edge(const Point &x, unsigned int i, double t) const;
  Iterate nearest_on_edge(const Point &x, unsigned int i) const;
  Iterate descend_from_all(const Point &x) const;
  bool has_one_minimum(const Point &x, double convexity) const;
  Matrix metric(const Point &p_u, const Point &p_v) const { return {p_u * p_u, p_u * p_v, p_v * p_v}; }
  /// a·p,ij.
  Matrix bending(const Point &a) const { return {2. * (a * uu_), a * uv_, 2. * (a * vv_)}; }

  Point origin_, u_, v_, uu_, uv_, vv_; ///< p = origin + u_ u + v_ v + uu_ u² + uv_ u v + vv_ v²
};

} // namespace billet

#endif
