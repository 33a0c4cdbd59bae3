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
  std::vector<std::array<unsigned int, 3>> facets; ///< counter-clockwise when seen from outside

  /// Returns the diagonal of the box around the points [length].
  double size() const;
  /// Whether any facet has corners that are not collinear.
  bool has_area() const;
  /// Returns six times the volume that a closed mesh encloses; negative if its facets point inwards
  /// [length³].
  double six_volumes() const;
};

/// Reads the facets of all solids of an STL file, ASCII or binary; each facet has three points of
/// its own. Throws std::invalid_argument if the file is no STL file, is truncated, has no facet or
/// has a non-finite number. The message has the reason, and for an ASCII file the line. It also
/// throws if most normals in the file contradict the order of the corners.
TriangleMesh read_stl(const std::string &file_name);

/// Returns the mesh with points merged that are nearer than `tolerance` [length] to each other.
/// Facets of which two corners are merged are removed: their other two edges merge as well.
TriangleMesh weld(const TriangleMesh &mesh, double tolerance);

/// Edges of a mesh.
struct TriangleEdges {
  static constexpr unsigned int none = std::numeric_limits<unsigned int>::max();

  struct Edge {
    std::array<unsigned int, 2> points; ///< in the direction of the first facet
    std::array<unsigned int, 2> facets; ///< the second is `none` at a free edge
    /// Corner where the edge begins for each facet: 0, 1 or 2.
    std::array<unsigned int, 2> corners;
  };
  std::vector<Edge> edges;
  std::vector<std::array<unsigned int, 3>> of_facet; ///< edge from corner i to the next one

  /// Finds the edges. Throws std::invalid_argument with number and example if an edge has more than
  /// two facets, or two with the same direction along it.
  explicit TriangleEdges(const TriangleMesh &mesh);

  /// Returns a message such as "12 edges have a facet on one side only, such as that from (0, 0, 0)
  /// to (1, 0, 0)". It is empty if there is no free edge.
  std::string describe_open_edges(const TriangleMesh &mesh) const;
};

} // namespace billet

#endif
