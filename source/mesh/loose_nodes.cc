// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mesh/loose_nodes.h"

#include "billet/mesh/boundary_groups.h"
#include "billet/mesh/mesh_cursor.h"

#include <algorithm>

namespace billet {

namespace {

LooseNodes find_loose_nodes_of(const GroupedSet &set, const MeshFile &mesh,
                               const std::vector<std::vector<unsigned int>> &elements_at,
                               std::vector<char> &is_member) {
  for (const unsigned int node : set.members)
    is_member[node] = 1;
  std::set<unsigned int> elements;
  for (const unsigned int node : set.members)
    elements.insert(elements_at[node].begin(), elements_at[node].end());
  std::map<BoundaryGroups::Face, unsigned int> n_elements; // at each face
  for (const unsigned int e : elements)
    for (const auto &corners : hexahedron_faces) {
      BoundaryGroups::Face face{};
      std::transform(std::begin(corners), std::end(corners), face.begin(),
                     [&](const unsigned int corner) { return mesh.hexahedra[e].nodes[corner]; });
      std::sort(face.begin(), face.end());
      if (std::all_of(face.begin(), face.end(), [&](const unsigned int n) { return is_member[n] == 1; }))
        ++n_elements[face];
    }
  std::set<unsigned int> on_faces;
  for (const auto &[face, n] : n_elements)
    if (n == 1) // others are inside
      on_faces.insert(face.begin(), face.end());
  LooseNodes loose;
  std::set<long long> all;
  for (const unsigned int node : set.members) {
    is_member[node] = 0;
    all.insert(mesh.node_numbers[node]); // both sides of an extruded mesh have the same numbers
    if (on_faces.count(node) == 0)
      loose.numbers.insert(mesh.node_numbers[node]);
  }
  loose.n_nodes = all.size();
  return loose;
}

} // namespace

std::map<std::string, LooseNodes> find_loose_nodes(const MeshFile &mesh) {
  std::map<std::string, LooseNodes> result;
  if (mesh.node_sets.empty())
    return result;
  std::vector<std::vector<unsigned int>> elements_at(mesh.positions.size());
  for (unsigned int e = 0; e < mesh.hexahedra.size(); ++e)
    for (const unsigned int node : mesh.hexahedra[e].nodes)
      elements_at[node].push_back(e);
  std::vector<char> is_member(mesh.positions.size(), 0);
  const auto name_of = [](const FaceGroup &group) { return lower_case(writable_name(group.name)); };
  for (const GroupedSet &set : mesh.node_sets) {
    const FaceGroup &group = mesh.groups[set.group];
    const LooseNodes loose = find_loose_nodes_of(set, mesh, elements_at, is_member);
    if (loose.numbers.empty() || group.name.empty())
      continue;
    result[lower_case(writable_name(group.kind + " " + group.name))] = loose;
    if (std::count_if(mesh.groups.begin(), mesh.groups.end(),
                      [&](const FaceGroup &other) { return name_of(other) == name_of(group); }) == 1)
      result[name_of(group)] = loose;
  }
  return result;
}

} // namespace billet
