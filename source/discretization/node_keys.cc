// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/node_keys.h"

#include <algorithm>

namespace billet {

NodeKeys::NodeKeys(const Discretization &discretization) {
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body)
    for (const auto &element : discretization.elements(body))
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        keys_.emplace(element.dofs[std::size_t{3} * a], static_cast<std::uint64_t>(-1));
  // All elements around a node are on this rank, owned or as ghosts.
  for (const auto &cell : discretization.dof_handler().active_cell_iterators()) {
    if (cell->is_artificial())
      continue;
    const std::uint64_t first = n_element_nodes * element_key(cell);
    for (const unsigned int v : cell->vertex_indices()) {
      const auto entry = keys_.find(cell->vertex_dof_index(v, 0));
      if (entry != keys_.end())
        entry->second = std::min(entry->second, first + v);
    }
  }
}

} // namespace billet
