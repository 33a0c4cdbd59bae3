// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_BOUNDS_H
#define BILLET_CONTACT_TOOL_BOUNDS_H

#include "billet/contact/rigid_contact_parts.h"
#include "billet/contact/tool_springs.h"

namespace billet {

/// Contributions of contact with a tool to the bounds of explicit steps, at the last update().
class ToolBounds {
public:
  /// The parts must outlive this object.
  explicit ToolBounds(const RigidContactParts &parts) : parts_(parts) {}

  /// Returns the maximum stiffness of a node's normal spring at the end of the next step, if that
  /// has the same duration [force/length³].
  double stiffness_ahead(std::size_t i) const;
  /// Adds the stiffness of owned nodes that do not touch, but may soon do so [force/length].
  void add_near(NodalVectors &bounds) const;
  /// Adds nodes that cross the surface as ExplicitContact::add_crossings() does.
  void add_crossings(Crossings &crossings) const;
  /// Adds the crossings of the first step.
  void add_start_crossings(Crossings &crossings, const NodalVectors &velocities, double step) const;
  /// Returns Σ a·k a as ExplicitContact::stiffness_against_tool() does.
  double stiffness_against_tool() const;

private:
  /// Calls add(index of the slave node, area) for owned nodes that do not touch, but may soon do
  /// so.
  template <class Add> void visit_near(const Add &add) const;

  const RigidContactParts &parts_;
};

} // namespace billet

#endif
