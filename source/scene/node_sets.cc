// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/node_sets.h"

namespace billet {

void NodeSets::take(const MeshFile &file) {
  for (const GroupedSet &set : file.node_sets) {
    const std::string &name = file.groups[set.group].name;
    if (name.empty())
      continue;
    std::vector<bool> &marked = marks[name];
    marked.resize(file.positions.size(), false);
    for (const unsigned int node : set.members)
      marked[node] = true;
  }
}

namespace {

/// Marks the vertex in the middle of an object, which is a corner of its first child, if its own
/// are marked.
template <class Object>
void mark_middle(const Object &object, const unsigned int middle, std::vector<bool> &marked) {
  bool are_all = true;
  for (const unsigned int v : object->vertex_indices())
    are_all = are_all && marked[object->vertex_index(v)];
  if (are_all)
    marked[object->child(0)->vertex_index(middle)] = true;
}

} // namespace

void NodeSets::refine(const dealii::Triangulation<3> &mesh) {
  for (auto &[name, marked] : marks) {
    marked.resize(mesh.n_vertices(), false);
    for (const auto &cell : mesh.cell_iterators_on_level(mesh.n_levels() - 2)) {
      for (const unsigned int l : cell->line_indices())
        mark_middle(cell->line(l), 1, marked);
      for (const unsigned int f : cell->face_indices())
        mark_middle(cell->face(f), 3, marked);
      mark_middle(cell, 7, marked);
    }
  }
}

} // namespace billet
