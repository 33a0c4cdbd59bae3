// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_NODE_H
#define BILLET_CONTACT_TOOL_NODE_H

#include "billet/contact/rigid_contact_parts.h"

#include <type_traits>

namespace billet {

/// Evaluation of single nodes on a tool, (T1)-(T4), with a friction law or Frictionless. Without
/// inertia no node misses the surface's edge. `is_exact` is whether the kind of tangents is
/// ContactTangent::exact.
template <class Law, bool has_inertia, bool is_exact> class ToolNode {
public:
  static constexpr bool has_friction = !std::is_same_v<Law, Frictionless>;

  /// The parts must outlive this object.
  ToolNode(const RigidContactParts &parts, const ContactTangent kind)
      : parts_(parts), kind_(FrictionTangent::of(kind)) {}

  /// Computes the state of node i at `position` and, with friction, its history, which otherwise is
  /// null.
  ToolContactState evaluate(std::size_t i, const dealii::Tensor<1, 3> &position,
                            ToolFriction::History *history) const;

private:
  const RigidContactParts &parts_;
  const FrictionTangent kind_;
};

/// Calls visit(ToolNode) with the evaluation of the pair's friction law and scheme, for this kind
/// of tangents.
template <class Visit>
void visit_tool_node(const RigidContactParts &parts, const ContactTangent kind, const Visit &visit) {
  choose_friction(parts.pair.friction, [&](const auto &law) {
    using Law = std::decay_t<decltype(law)>;
    const bool is_exact = kind == ContactTangent::exact;
    if (parts.has_inertia && is_exact)
      visit(ToolNode<Law, true, true>(parts, kind));
    else if (parts.has_inertia)
      visit(ToolNode<Law, true, false>(parts, kind));
    else if (is_exact)
      visit(ToolNode<Law, false, true>(parts, kind));
    else
      visit(ToolNode<Law, false, false>(parts, kind));
  });
}

} // namespace billet

#endif
