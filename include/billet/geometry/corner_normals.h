// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_CORNER_NORMALS_H
#define BILLET_GEOMETRY_CORNER_NORMALS_H

#include "billet/geometry/triangle_mesh.h"

namespace billet {

/// Returns the angle between unit vectors, accurate for small angles [radians].
double angle_between(const dealii::Tensor<1, 3> &a, const dealii::Tensor<1, 3> &b);

/// Normals and areas of the flat facets of a mesh.
struct FacetNormals {
  std::vector<dealii::Tensor<1, 3>> normals;
  /// 0 for slivers of negligible height, which take the normal of a neighbour.
  std::vector<double> areas;
  double sliver_height = 0.; ///< maximum height of a sliver [length]

  FacetNormals(const TriangleMesh &mesh, const TriangleEdges &edges);

  /// Whether the normals differ by more than `sharp_angle` [radians], or the edge has one facet
  /// only.
  bool is_sharp(const TriangleEdges::Edge &edge, const double sharp_angle) const {
    return edge.facets[1] == TriangleEdges::none ||
           angle_between(normals[edge.facets[0]], normals[edge.facets[1]]) > sharp_angle;
  }
};

/// Normal at each corner of each facet.
using CornerNormals = std::vector<std::array<dealii::Tensor<1, 3>, 3>>;

/// Computes the corner normals. Around a point, facets that meet in smooth edges share the mean of
/// their normals. The weights are area/(a b)², with a and b the sides there (Max 1999, exact on
/// spheres).
///
/// In a flat region of radius r the weights are multiplied by (r/1.4 r_min)⁸ if that exceeds 1.
/// Here r_min is the minimum radius around the point. So the normal at the start of a fillet is
/// that of the flat face, which otherwise would bulge.
CornerNormals corner_normals(const TriangleMesh &mesh, const TriangleEdges &edges, const FacetNormals &facets,
                             double sharp_angle);

} // namespace billet

#endif
