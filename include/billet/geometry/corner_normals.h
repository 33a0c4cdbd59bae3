// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_CORNER_NORMALS_H
#define BILLET_GEOMETRY_CORNER_NORMALS_H

#include "billet/geometry/triangle_mesh.h"

namespace billet {

/// Angle between unit vectors, accurate where it is small [radians].
double angle_between(const dealii::Tensor<1, 3> &a, const dealii::Tensor<1, 3> &b);

/// The flat facets of a mesh.
struct FacetNormals {
  std::vector<dealii::Tensor<1, 3>> normals;
  std::vector<double> areas; ///< 0 for slivers of next to no height: they have the normal of a neighbour
  double sliver_height = 0.; ///< no sliver is higher [length]

  FacetNormals(const TriangleMesh &mesh, const TriangleEdges &edges);

  /// Whether normals differ by more than `sharp_angle` [radians], or the edge is a border.
  bool is_sharp(const TriangleEdges::Edge &edge, const double sharp_angle) const {
    return edge.facets[1] == TriangleEdges::none ||
           angle_between(normals[edge.facets[0]], normals[edge.facets[1]]) > sharp_angle;
  }
};

/// Of each corner of each facet.
using CornerNormals = std::vector<std::array<dealii::Tensor<1, 3>, 3>>;

/// Around a point, facets that meet in edges that are not sharp share the mean of their normals, with weights
/// area/(a b)², a and b the sides there (Max 1999, exact on spheres). Where one of several flat regions is
/// wider than another, its facets count (r/1.4 r_least)⁸ times, r the radius of the region and r_least the
/// least one around the point, when that is more than once: where a fillet begins, the normal is that of the
/// flat face, which else would bulge.
CornerNormals corner_normals(const TriangleMesh &mesh, const TriangleEdges &edges, const FacetNormals &facets,
                             double sharp_angle);

} // namespace billet

#endif
