// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mesh/mesh_collector.h"

#include <algorithm>
#include <stdexcept>

namespace billet {

void MeshCollector::add_node(const long long number, const std::array<double, 3> &position) {
  if (!node_index_.emplace(number, static_cast<unsigned int>(mesh_.positions.size())).second)
    throw std::invalid_argument(node_word_ + " " + std::to_string(number) + " of it is given twice");
  mesh_.node_numbers.push_back(number);
  mesh_.positions.push_back(position);
}

void MeshCollector::add_cell(const CellShape &shape, const long long number, const long long *const nodes,
                             const std::vector<std::size_t> &groups) {
  ++n_cells_[shape.kind];
  if (shape.kind == CellKind::hexahedron) {
    hexahedra_.push_back({number, {}});
    std::copy_n(nodes, 8, hexahedra_.back().nodes.begin());
  } else if (shape.kind == CellKind::quadrilateral) {
    quadrilaterals_.push_back({number, {nodes[0], nodes[1], nodes[2], nodes[3]}});
    for (const std::size_t group : groups)
      add_face({nodes[0], nodes[1], nodes[2], nodes[3]}, group);
  }
}

void MeshCollector::add_face(const std::array<long long, 4> &nodes, const std::size_t group) {
  faces_.push_back({nodes, group});
}

void MeshCollector::add_edge(const std::array<long long, 2> &nodes, const FaceGroup &group) {
  edges_.push_back({nodes, group});
}

namespace {

/// Returns a name without control characters: names appear in messages.
std::string without_controls(std::string name) {
  for (char &c : name)
    c = static_cast<unsigned char>(c) < ' ' || c == '\x7F' ? '?' : c;
  return name;
}

} // namespace

std::size_t MeshCollector::volume(const std::string &name, const unsigned int number, const bool is_part) {
  const std::string printable = without_controls(name);
  const auto [found, is_new] = volume_index_.emplace(std::pair(printable, number), mesh_.volumes.size());
  if (is_new)
    mesh_.volumes.push_back({printable, number, is_part});
  return found->second;
}

void MeshCollector::finish_volumes(const std::unordered_map<long long, unsigned int> &hexahedra) {
  for (const auto &[volume, number] : volume_members_)
    mesh_.volumes[volume].members.push_back(hexahedra.at(number));
  for (MeshVolume &volume : mesh_.volumes) {
    std::sort(volume.members.begin(), volume.members.end());
    volume.members.erase(std::unique(volume.members.begin(), volume.members.end()), volume.members.end());
  }
}

std::size_t MeshCollector::group(const std::string &name, const unsigned int number,
                                 const std::string &kind) {
  const std::string printable = without_controls(name);
  const auto [found, is_new] = group_index_.emplace(std::tuple(printable, number, kind), mesh_.groups.size());
  if (is_new)
    mesh_.groups.push_back({printable, number, kind});
  return found->second;
}

void MeshCollector::check_number(const long long number) {
  constexpr long long max_number = 999999999; // as in scenes
  if (number < 0 || number > max_number)
    throw std::invalid_argument("a group of faces of it has the number " + std::to_string(number) +
                                ", which is no boundary id from 0 to 999999999");
}

std::size_t MeshCollector::numbered_group(const long long number) {
  check_number(number);
  return group("", static_cast<unsigned int>(number));
}

unsigned int MeshCollector::node_index(const long long number, const char *const named_by,
                                       const long long name) const {
  const auto found = node_index_.find(number);
  if (found == node_index_.end())
    throw std::invalid_argument(std::string(named_by) + " " + std::to_string(name) + " of it names " +
                                node_word_ + " " + std::to_string(number) + ", which is missing");
  return found->second;
}

std::size_t MeshCollector::count(const CellKind kind) const {
  const auto found = n_cells_.find(kind);
  return found == n_cells_.end() ? std::size_t{0} : found->second;
}

void MeshCollector::check_kinds() const {
  if (count(CellKind::second_order) > 0)
    throw std::invalid_argument(
        "it has " + std::to_string(count(CellKind::second_order)) +
        " elements of second order; allowed are hexahedra with eight nodes (in Gmsh: Mesh.ElementOrder = 1)");
  std::string others;
  for (const auto &[kind, name] :
       {std::pair(CellKind::tetrahedron, "tetrahedra"), std::pair(CellKind::wedge, "wedges"),
        std::pair(CellKind::pyramid, "pyramids")})
    if (count(kind) > 0)
      others += (others.empty() ? "" : ", ") + std::to_string(count(kind)) + " " + name;
  if (!others.empty())
    throw std::invalid_argument(
        "it has " + others + " beside " + std::to_string(count(CellKind::hexahedron)) +
        " hexahedra; allowed are hexahedra only. Gmsh divides all elements into hexahedra with "
        "Mesh.SubdivisionAlgorithm = 2 (All Hexas), set before the mesh is generated; a swept mesh "
        "(Extrude with Recombine) is more accurate in bending");
  if (count(CellKind::hexahedron) == 0 && count(CellKind::quadrilateral) == 0)
    throw std::invalid_argument(
        "it has no hexahedra, nor quadrilaterals with four nodes as a two-dimensional mesh has" +
        (count(CellKind::triangle) > 0 ? ", but " + std::to_string(count(CellKind::triangle)) +
                                             " triangles; Gmsh joins them with 'Recombine Surface {:};'"
                                       : " (in Gmsh: Mesh.ElementOrder = 1)"));
}

void MeshCollector::finish_plane() {
  std::unordered_map<long long, std::size_t> numbers;
  for (const Quadrilateral &quadrilateral : quadrilaterals_) {
    if (!numbers.emplace(quadrilateral.number, 0).second)
      throw std::invalid_argument("element " + std::to_string(quadrilateral.number) +
                                  " of it is given twice");
    mesh_.plane.quadrilaterals.push_back({quadrilateral.number, {}});
    std::transform(quadrilateral.nodes.begin(), quadrilateral.nodes.end(),
                   mesh_.plane.quadrilaterals.back().nodes.begin(),
                   [&](const long long node) { return node_index(node, "element", quadrilateral.number); });
  }
  for (const Edge &edge : edges_) {
    if (edge.group.number != FaceGroup::no_number)
      check_number(edge.group.number);
    mesh_.plane.edges.push_back({{node_index(edge.nodes[0], "an edge at node", edge.nodes[0]),
                                  node_index(edge.nodes[1], "an edge at node", edge.nodes[0])},
                                 group(edge.group.name, edge.group.number, edge.group.kind)});
  }
  mesh_.plane.n_triangles = count(CellKind::triangle);
}

MeshFile MeshCollector::finish() {
  check_kinds();
  if (hexahedra_.empty())
    finish_plane();
  std::unordered_map<long long, unsigned int> numbers;
  for (const Hexahedron &hexahedron : hexahedra_) {
    if (!numbers.emplace(hexahedron.number, static_cast<unsigned int>(mesh_.hexahedra.size())).second)
      throw std::invalid_argument("element " + std::to_string(hexahedron.number) + " of it is given twice");
    mesh_.hexahedra.push_back({hexahedron.number, {}});
    std::transform(hexahedron.nodes.begin(), hexahedron.nodes.end(), mesh_.hexahedra.back().nodes.begin(),
                   [&](const long long node) { return node_index(node, "element", hexahedron.number); });
  }
  for (const Face &face : faces_) {
    mesh_.faces.push_back({{}, face.group});
    std::transform(face.nodes.begin(), face.nodes.end(), mesh_.faces.back().nodes.begin(),
                   [&](const long long node) { return node_index(node, "a face at node", face.nodes[0]); });
  }
  finish_volumes(numbers);
  return std::move(mesh_);
}

} // namespace billet
