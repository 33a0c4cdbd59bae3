// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_NODE_KEYS_H
#define BILLET_DISCRETIZATION_NODE_KEYS_H

#include "billet/discretization/discretization.h"
#include "billet/discretization/element_key.h"

#include <cstdint>
#include <unordered_map>

namespace billet {

inline ElementKey element_key(const CellIterator &cell) { return element_key(cell->id()); }

/// Keys of nodes, the same on any number of ranks. A key is 8 times that of the first element of
/// the whole mesh that has the node, plus the node's place in it. On one rank they ascend as dofs
/// do.
class NodeKeys {
public:
  explicit NodeKeys(const Discretization &discretization);

  /// Returns the key of a node of an owned element, by its first dof.
  std::uint64_t operator()(const DofIndex first_dof) const { return keys_.at(first_dof); }

private:
  std::unordered_map<DofIndex, std::uint64_t> keys_;
};

} // namespace billet

#endif
