// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mesh/plane_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

namespace billet {

namespace {

/// Returns twice the area, positive if the corners are in turn about z.
double signed_area(const MeshFile &mesh, const FileQuadrilateral &quadrilateral) {
  const auto &x = mesh.positions;
  const auto &n = quadrilateral.nodes;
  const double a[2] = {x[n[2]][0] - x[n[0]][0], x[n[2]][1] - x[n[0]][1]},
               b[2] = {x[n[3]][0] - x[n[1]][0], x[n[3]][1] - x[n[1]][1]};
  return a[0] * b[1] - a[1] * b[0];
}

void check_kinds(const MeshFile &mesh) {
  if (!mesh.hexahedra.empty())
    throw std::invalid_argument("it has " + std::to_string(mesh.hexahedra.size()) +
                                " hexahedra; allowed are quadrilaterals in a plane, since 'Section' asks for "
                                "a two-dimensional mesh. With hexahedra, leave 'Section = solid'");
  if (mesh.plane.n_triangles > 0)
    throw std::invalid_argument("it has " + std::to_string(mesh.plane.n_triangles) + " triangles beside " +
                                std::to_string(mesh.plane.quadrilaterals.size()) +
                                " quadrilaterals; allowed are quadrilaterals only. Gmsh divides all elements "
                                "into these with Mesh.SubdivisionAlgorithm = 1 (All Quads), set before the "
                                "mesh is generated");
}

/// Returns the size of the mesh of the nodes that quadrilaterals use. Refuses a mesh that is in no
/// plane z = constant.
double size_in_plane(const MeshFile &mesh) {
  constexpr double rounding = 1e-9;
  std::array<double, 3> least = mesh.positions[mesh.plane.quadrilaterals.front().nodes[0]], most = least;
  for (const FileQuadrilateral &quadrilateral : mesh.plane.quadrilaterals)
    for (const unsigned int node : quadrilateral.nodes)
      for (unsigned int c = 0; c < 3; ++c) {
        least[c] = std::min(least[c], mesh.positions[node][c]);
        most[c] = std::max(most[c], mesh.positions[node][c]);
      }
  const double size = std::hypot(most[0] - least[0], most[1] - least[1]), height = most[2] - least[2];
  if (height > rounding * size) {
    std::ostringstream message;
    message << "its quadrilaterals reach from z = " << least[2] << " to z = " << most[2]
            << "; allowed is a two-dimensional mesh in a plane z = constant, since 'Section' asks for one";
    throw std::invalid_argument(message.str());
  }
  return size;
}

} // namespace

namespace {

/// Makes the groups of quadrilaterals volumes of the layer.
void find_plane_volumes(MeshFile &mesh) {
  std::map<std::array<unsigned int, 4>, unsigned int> index;
  for (unsigned int i = 0; i < mesh.plane.quadrilaterals.size(); ++i) {
    auto nodes = mesh.plane.quadrilaterals[i].nodes;
    std::sort(nodes.begin(), nodes.end());
    index.emplace(nodes, i);
  }
  std::map<std::size_t, std::set<unsigned int>> members;
  for (const GroupedFace &face : mesh.faces) {
    auto nodes = face.nodes;
    std::sort(nodes.begin(), nodes.end());
    if (const auto found = index.find(nodes); found != index.end())
      members[face.group].insert(found->second);
  }
  for (const auto &[group, quadrilaterals] : members) {
    const FaceGroup &surface = mesh.groups[group];
    if (surface.number != 0 || !surface.name.empty()) // 0 are those in no group
      mesh.volumes.push_back({surface.name,
                              surface.number,
                              surface.number != FaceGroup::no_number,
                              {quadrilaterals.begin(), quadrilaterals.end()}});
  }
}

} // namespace

void extrude_plane(MeshFile &mesh) {
  check_kinds(mesh);
  const double size = size_in_plane(mesh);
  const auto n = static_cast<unsigned int>(mesh.positions.size());
  for (unsigned int node = 0; node < n; ++node) {
    mesh.positions[node][2] = 0.;
    mesh.positions.push_back({mesh.positions[node][0], mesh.positions[node][1], size});
    mesh.node_numbers.push_back(mesh.node_numbers[node]);
  }
  for (const FileQuadrilateral &quadrilateral : mesh.plane.quadrilaterals) {
    std::array<unsigned int, 4> nodes = quadrilateral.nodes;
    if (signed_area(mesh, quadrilateral) < 0.)
      std::swap(nodes[1], nodes[3]);
    FileHexahedron hexahedron{quadrilateral.number, {}};
    for (unsigned int i = 0; i < 4; ++i) {
      hexahedron.nodes[i] = nodes[i];
      hexahedron.nodes[i + 4] = nodes[i] + n;
    }
    mesh.hexahedra.push_back(hexahedron);
  }
  find_plane_volumes(mesh);
  mesh.faces.clear(); // groups of quadrilaterals are the body, not its boundary
  for (const GroupedEdge &edge : mesh.plane.edges)
    mesh.faces.push_back({{edge.nodes[0], edge.nodes[1], edge.nodes[1] + n, edge.nodes[0] + n}, edge.group});
  for (GroupedSet &set : mesh.node_sets) {
    const std::size_t n_members = set.members.size();
    for (std::size_t i = 0; i < n_members; ++i)
      set.members.push_back(set.members[i] + n);
  }
  mesh.element_sets.clear(); // of hexahedra, of which the file has none
  mesh.plane = {};
}

} // namespace billet
