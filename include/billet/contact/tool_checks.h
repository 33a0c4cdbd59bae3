// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_CHECKS_H
#define BILLET_CONTACT_TOOL_CHECKS_H

#include "billet/contact/contact_checks.h"
#include "billet/contact/rigid_contact_parts.h"

namespace billet {

/// Checks of contact with a tool: small tools, which nodes miss or pass through, and edges.
class ToolChecks final : public ContactChecks {
public:
  /// The parts must outlive this object.
  explicit ToolChecks(const RigidContactParts &parts) : parts_(parts) {}

  /// Returns a message if the tool fits between the contact points.
  DiagnosticList check_start() const override;
  /// Returns a message if nodes have been found behind the tool.
  DiagnosticList check_step() const override;
  /// Whether the tool is thinner than two facets: only then can nodes pass through it.
  bool may_let_nodes_through() const override { return parts_.thin_tool.has_value(); }
  /// Valid after update() and before commit(); false in the first step after load().
  bool lets_nodes_through() const override;
  Explanation describe_passage() const override;
  std::string describe_obstacle() const override;
  /// Whether nodes of this rank are restless. Not collective.
  bool has_restless() const { return parts_.restless.has_any(); }
  Explanation describe_restless() const override;
  /// Whether the edge of the tool's surface is within a tenth of a facet of this rank's node at
  /// `position`.
  bool has_node_on_edge(const dealii::Tensor<1, 3> &position) const;

private:
  /// Whether the tool turns by 45 degrees within half a facet of a node of this rank.
  bool is_at_sharp_edge(std::size_t i) const;

  const RigidContactParts &parts_;
};

} // namespace billet

#endif
