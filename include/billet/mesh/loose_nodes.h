// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MESH_LOOSE_NODES_H
#define BILLET_MESH_LOOSE_NODES_H

#include "billet/mesh/mesh_file.h"

#include <map>
#include <set>
#include <string>

namespace billet {

/// Nodes of a set that are on no exterior face with all its nodes in the set.
struct LooseNodes {
  std::set<long long> numbers; ///< in the file
  std::size_t n_nodes = 0;     ///< of the whole set
};

/// Returns the loose nodes of all node sets that have any, by the names that a scene may write, in
/// lower case. A name that another group has, too, stands for that group and not for the set.
std::map<std::string, LooseNodes> find_loose_nodes(const MeshFile &mesh);

} // namespace billet

#endif
