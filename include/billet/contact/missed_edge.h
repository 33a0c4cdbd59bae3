// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_MISSED_EDGE_H
#define BILLET_CONTACT_MISSED_EDGE_H

#include "billet/contact/neighbouring_tools.h"
#include "billet/contact/tool_contact_state.h"

#include <vector>

namespace billet {

/// Nodes that have missed the edge of a tool's surface, in schemes with inertia: they are beyond it
/// and deeper than w below the surface. A node that moves back in meets the back of the surface,
/// which has no contact, until it comes out in front again. Otherwise it would jump to its full
/// penetration in a step or two and create energy. The rule does not apply where another tool is
/// near, nor to a part of the surface that the node approaches from the front.
class MissedEdge {
public:
  /// Both arguments must outlive this object.
  MissedEdge(const ToolStep &step, const NeighbouringTools &neighbours)
      : step_(step), neighbours_(neighbours) {}

  /// Whether a node at this position has missed the edge. `on_tool` is the position in the tool's
  /// coordinates, `projection` that on the surface.
  bool is_missed_by(const ContactPoint &node, const dealii::Tensor<1, 3> &position,
                    const dealii::Tensor<1, 3> &on_tool, const RigidSurface::Projection &projection) const;

  /// Makes the states of nodes at the end of the step those at the start of the next one.
  void commit(std::vector<ContactPoint> &nodes, const std::vector<ToolContactState> &states);
  /// Whether a node of this rank has moved behind the surface in any step.
  bool has_nodes_behind() const { return has_nodes_behind_; }

  static void save(StateWriter &writer, const std::vector<ContactPoint> &nodes,
                   const SlaveSurface::Range &range);
  static void load(const StateReader &reader, std::vector<ContactPoint> &nodes,
                   const SlaveSurface::Range &range);

private:
  const ToolStep &step_;
  const NeighbouringTools &neighbours_;
  bool has_nodes_behind_ = false;
};

} // namespace billet

#endif
