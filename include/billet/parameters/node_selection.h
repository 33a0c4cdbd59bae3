// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_NODE_SELECTION_H
#define BILLET_PARAMETERS_NODE_SELECTION_H

#include "billet/parameters/reader.h"

#include <array>
#include <string>
#include <vector>

namespace billet {

/// Nodes of one body, by their undeformed positions or by the node sets of its mesh file.
struct NodeSelection {
  std::vector<dealii::Tensor<1, 3>> points;               ///< a node at each of them
  std::vector<std::array<dealii::Tensor<1, 3>, 2>> lines; ///< all nodes on each of these segments
  std::vector<std::string> sets;
  std::string origin; ///< place in the scene file, for messages

  bool is_empty() const { return points.empty() && lines.empty() && sets.empty(); }
};

/// Meaning of a parameter that selects nodes, for its description.
extern const char *const node_selection_meaning;

/// Reads the nodes of the parameter `key`; none if it is empty.
NodeSelection read_nodes(const Reader &reader, const std::string &key);

} // namespace billet

#endif
