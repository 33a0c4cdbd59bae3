// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FORCES_SELECTED_NODES_H
#define BILLET_FORCES_SELECTED_NODES_H

#include "billet/discretization/discretization.h"
#include "billet/scene/scene.h"

#include <vector>

namespace billet {

/// Node on which a load acts.
struct SelectedNode {
  std::array<DofIndex, 3> dofs;
  dealii::Point<3> position; ///< undeformed
};

/// Returns the nodes of this rank's elements that a load selects, each once; none unless it has
/// 'Nodes'.
std::vector<SelectedNode> collect_selected_nodes(const AppliedLoad &load,
                                                 const Discretization &discretization, std::size_t body);

/// Place where a spring of the ground supports a body.
struct SpringSite {
  SelectedNode node;
  std::vector<dealii::Tensor<1, 3>> directions; ///< unit vectors, in which it resists
};

/// Returns the springs of a load on this rank: those in the corners of its faces, or on its nodes.
std::vector<SpringSite> collect_springs(const AppliedLoad &load, const Discretization &discretization,
                                        std::size_t body);

} // namespace billet

#endif
