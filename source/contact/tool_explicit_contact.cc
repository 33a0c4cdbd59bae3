// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/tool_explicit_contact.h"

#include <vector>

namespace billet {

ToolExplicitContact::ToolExplicitContact(RigidContactParts &parts, const LocalNodes &nodes)
    : parts_(parts), evaluation_(make_tool_evaluation(parts, ContactTangent::consistent)), bounds_(parts),
      forces_(parts) {
  BoundNodes &bound = parts.bound;
  for (std::size_t i = 0; i < parts.slaves.n_mesh_nodes; ++i) {
    bound.local.push_back(nodes.find(parts.slaves.nodes[i].dofs[0]));
    bound.is_owned.push_back(nodes.is_owned(bound.local.back()));
  }
  bound.is_owned.resize(parts.slaves.nodes.size(), true);
}

void ToolExplicitContact::begin(const ContactStep &step, const NodalVectors &displacements) {
  std::vector<dealii::Tensor<1, 3>> of_nodes;
  for (std::size_t i = 0; i < parts_.slaves.n_mesh_nodes; ++i)
    of_nodes.push_back(parts_.bound.vector_of(i, displacements));
  parts_.begin(step, of_nodes);
}

} // namespace billet
