// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_CURVED_TRIANGLES_H
#define BILLET_GEOMETRY_CURVED_TRIANGLES_H

#include "billet/geometry/corner_normals.h"
#include "billet/geometry/curved_triangle.h"

#include <memory>

namespace billet {

/// Surface of curved triangles that interpolate normals at their corners. The triangles share
/// points and edges, so the surface has no gaps for any normals; where it is smooth they share
/// normals, too.
///
/// *Edges* are Nagata's (2005) parabolas, orthogonal to the normals at their ends. They lie in the
/// plane of the chord d and the mean normal ν = (n_0 + n_1)/2. With m_0 = n_0·d and m_1 = −n_1·d
/// their bend is
///   c = 2 m_0 m_1/((m_0 + m_1) ν·ν) ν + (m_0 − m_1)/(m_0 + m_1) d.
/// Unlike the minimum-norm solution, it stays finite as the normals become parallel. It is 0 if m_0
/// and m_1 differ in sign, since a parabola has no inflection; the part along d is at most d/2.
///
/// At a sharp edge the tangents at the ends are orthogonal to the normals of both sides: n_a × n_b.
///
/// *Seams.* Along a smooth edge the terms F rotate both triangles until they are orthogonal to
/// n(t) − (n·x')x'/x'². Here n(t) is linear between n_0 and n_1, and x' is the edge's tangent. F is
/// fitted at two points of the edge. Between them the normals differ by O(h⁵); without F, by O(h³).
class CurvedTriangles {
public:
  /// Makes the triangles. Facets whose normals differ by more than `sharp_angle` [radians] meet in
  /// a sharp edge. Without `is_smoothed` all triangles are flat. `mesh` must be welded and have
  /// facets with an area.
  CurvedTriangles(const TriangleMesh &mesh, const TriangleEdges &edges, double sharp_angle, bool is_smoothed);

  /// Returns a patch for each facet that has an area.
  static SurfacePatches patches(const std::shared_ptr<const CurvedTriangles> &triangles);

  CurvedTriangle triangle(const unsigned int facet) const {
    const auto &corners = mesh_.facets[facet];
    const auto &edges = edges_of_facet_[facet];
    return {{mesh_.points[corners[0]], mesh_.points[corners[1]], mesh_.points[corners[2]]},
            {bends_[edges[0]], bends_[edges[1]], bends_[edges[2]]},
            seams_[facet]};
  }
  /// Returns the maximum distance between the triangles on both sides of slivers, which are omitted
  /// [length].
  double edge_accuracy() const { return facets_.sliver_height; }
  const CurvedTriangle::Shape &shape(const unsigned int facet) const { return shapes_[facet]; }

private:
  void bend_edges(const TriangleEdges &edges, const CornerNormals &normals, double sharp_angle);
  void straighten_where_folded();
  bool is_folded(unsigned int facet) const;
  void join_normals(const TriangleEdges &edges, const CornerNormals &normals, double sharp_angle);
  CurvedTriangle::Seam seam_at(unsigned int facet, unsigned int corner, const CornerNormals &normals) const;

  TriangleMesh mesh_;
  std::vector<std::array<unsigned int, 3>> edges_of_facet_;
  FacetNormals facets_;
  std::vector<dealii::Tensor<1, 3>> bends_;                ///< one per edge
  std::vector<std::array<CurvedTriangle::Seam, 3>> seams_; ///< one per triangle and edge
  std::vector<CurvedTriangle::Shape> shapes_;              ///< one per triangle
};

} // namespace billet

#endif
