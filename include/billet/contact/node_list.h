// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_NODE_LIST_H
#define BILLET_CONTACT_NODE_LIST_H

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace billet {

/// Returns the index of a node in a short list; the list's size if it is not in it.
inline std::size_t index_of(const std::vector<unsigned int> &nodes, const unsigned int node) {
  return static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
}

/// Appends those of a facet's nodes that are not in the list.
inline void add_once(std::vector<unsigned int> &nodes, const std::array<unsigned int, 4> &more) {
  for (const unsigned int node : more)
    if (index_of(nodes, node) == nodes.size())
      nodes.push_back(node);
}

} // namespace billet

#endif
