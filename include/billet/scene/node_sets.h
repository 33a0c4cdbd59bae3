// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_NODE_SETS_H
#define BILLET_SCENE_NODE_SETS_H

#include "billet/mesh/mesh_file.h"

#include <deal.II/grid/tria.h>

#include <map>
#include <string>
#include <vector>

namespace billet {

/// Named node sets of a mesh file, as marks of the vertices of the mesh that is made of it.
struct NodeSets {
  std::map<std::string, std::vector<bool>> marks;

  /// Takes the sets of a file, whose nodes are the vertices.
  void take(const MeshFile &file);
  /// Follows one uniform refinement: a new vertex is in a set if all that it is the middle of are.
  void refine(const dealii::Triangulation<3> &mesh);
};

} // namespace billet

#endif
