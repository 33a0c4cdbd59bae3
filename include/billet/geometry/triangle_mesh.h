// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_TRIANGLE_MESH_H
#define BILLET_GEOMETRY_TRIANGLE_MESH_H

#include <deal.II/base/tensor.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace billet {

/// Flat triangles over points.
struct TriangleMesh {
  std::vector<dealii::Tensor<1, 3>> points;
  std::vector<std::array<unsigned int, 3>> facets; ///< counter-clockwise for one who stands outside

  /// Diagonal of the box around the points [length].
  double size() const;
  /// Whether any facet has corners that are not in line.
  bool has_area() const;
  /// Six times the volume that a closed mesh encloses; negative if its facets look inwards [length³].
  double six_volumes() const;
};

/// Reads an STL file, ASCII or binary; the facets of all its solids, each with three points of its own.
/// Throws std::invalid_argument with the reason (in an ASCII file, with the line) where it is none, is cut
/// short, holds no facet or a number that is not finite, or where the normals written in it are mostly
/// against the order of the corners.
TriangleMesh read_stl(const std::string &file_name);

/// The mesh with points nearer than `tolerance` [length] to each other made one. Facets of which two corners
/// become one are left out: their other two edges become one as well.
TriangleMesh weld(const TriangleMesh &mesh, double tolerance);

/// The edges of a mesh.
struct TriangleEdges {
  static constexpr unsigned int none = std::numeric_limits<unsigned int>::max();

  struct Edge {
    std::array<unsigned int, 2> points;  ///< in the order in which the first facet walks them
    std::array<unsigned int, 2> facets;  ///< the second is `none` at a border
    std::array<unsigned int, 2> corners; ///< of the facets, where the edge begins as they walk it: 0, 1 or 2
  };
  std::vector<Edge> edges;
  std::vector<std::array<unsigned int, 3>> of_facet; ///< the edge from corner i to the next one

  /// Throws std::invalid_argument with number and example where an edge has more than two facets, or two that
  /// walk it in the same direction.
  explicit TriangleEdges(const TriangleMesh &mesh);

  /// "12 edges have a facet on one side only, such as that from (0, 0, 0) to (1, 0, 0)"; empty if there is no
  /// such edge.
  std::string describe_border(const TriangleMesh &mesh) const;
};

} // namespace billet

#endif
