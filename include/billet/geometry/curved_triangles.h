// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_CURVED_TRIANGLES_H
#define BILLET_GEOMETRY_CURVED_TRIANGLES_H

#include "billet/geometry/quadratic_triangle.h"
#include "billet/geometry/triangle_mesh.h"

#include <memory>

namespace billet {

/// A surface of triangles that follow normals at their corners. The triangles share points and edges, so that
/// the surface has no gaps whatever the normals are.
///
/// *Normals.* Around a point, facets that meet in smooth edges share the mean of their normals, with weights
/// area/(a b)², a and b the sides there (Max 1999, exact on spheres). Two or more facets in one plane count
/// (A/1.4 A_least)⁴ times, A the area of this flat region and A_least the least around the point, when that
/// is more than once: where a fillet begins, the normal is that of the flat face, which else would bulge.
///
/// *Edges* are Nagata's (2005) parabolas, orthogonal to the normals at their ends. In the plane of the chord
/// d and the mean normal ν = (n_0 + n_1)/2, with m_0 = n_0·d and m_1 = −n_1·d,
///   c = 2 m_0 m_1/((m_0 + m_1) ν·ν) ν + (m_0 − m_1)/(m_0 + m_1) d,
/// which, other than the solution of least norm, stays finite as the normals become parallel. It is 0 where
/// m_0 and m_1 differ in sign, since no parabola turns both ways; the part along d is at most d/2. At a sharp
/// edge the tangents at the ends are where the normals of both sides allow them, n_a × n_b.
class CurvedTriangles {
public:
  /// Facets whose normals differ by more than `sharp_angle` [radians] meet in a sharp edge; `is_smoothed`:
  /// else all triangles are flat. `mesh` is welded, and has facets with an area.
  CurvedTriangles(const TriangleMesh &mesh, const TriangleEdges &edges, double sharp_angle, bool is_smoothed);

  /// A patch for each facet that has an area.
  static std::vector<std::unique_ptr<const SurfacePatch>>
  patches(const std::shared_ptr<const CurvedTriangles> &triangles);

  QuadraticTriangle triangle(const unsigned int facet) const {
    const auto &corners = mesh_.facets[facet];
    const auto &edges = edges_of_facet_[facet];
    return {{mesh_.points[corners[0]], mesh_.points[corners[1]], mesh_.points[corners[2]]},
            {bends_[edges[0]], bends_[edges[1]], bends_[edges[2]]}};
  }
  /// How far the triangles on both sides of slivers, which are left out, may be apart [length].
  double border_accuracy() const { return border_accuracy_; }
  double convexity(const unsigned int facet) const { return convexity_[facet]; }

private:
  using Normals = std::vector<std::array<dealii::Tensor<1, 3>, 3>>; ///< of each corner of each facet

  void find_facet_normals(const TriangleEdges &edges);
  std::vector<double> flat_region_areas(const TriangleEdges &edges) const;
  Normals corner_normals(const TriangleEdges &edges, double sharp_angle) const;
  void bend_edges(const TriangleEdges &edges, const Normals &normals, double sharp_angle);
  void straighten_where_folded();
  bool is_sharp(const TriangleEdges::Edge &edge, double sharp_angle) const;

  TriangleMesh mesh_;
  std::vector<std::array<unsigned int, 3>> edges_of_facet_;
  std::vector<dealii::Tensor<1, 3>> bends_;         ///< of the edges
  std::vector<float> convexity_;                    ///< of the triangles
  std::vector<double> areas_;                       ///< of the flat facets, 0 if next to nothing
  std::vector<dealii::Tensor<1, 3>> facet_normals_; ///< of the flat facets; for the set-up only
  double border_accuracy_ = 0.;
};

} // namespace billet

#endif
