// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_STEP_H
#define BILLET_CONTACT_TOOL_STEP_H

#include "billet/contact/slave_surface.h"
#include "billet/geometry/placement.h"
#include "billet/geometry/rigid_surface.h"
#include "billet/scene/scene.h"

#include <algorithm>
#include <cmath>

namespace billet {

/// Time in which depths that a finer mesh has brought about fade.
struct FadingGaps {
  double begin, end; ///< [time]; an infinite end: they never fade

  bool fade() const { return std::isfinite(end); }
  /// Returns the part of these depths that counts as none at time t.
  double part(const double t) const {
    return !fade() ? 1. : end > begin ? std::clamp((end - t) / (end - begin), 0., 1.) : 0.;
  }
};

/// A rigid tool in the step of a contact pair.
struct ToolStep {
  /// Constructs a tool at rest. Keeps a reference to the surface.
  ToolStep(const RigidSurface &of_tool, const Placement &at_start)
      : surface(of_tool), placement_n(at_start), placement(at_start) {}

  const RigidSurface &surface;
  Placement placement_n, placement; ///< at the start of the step, and at its end
  double duration = 0.;             ///< [time]
  /// Parts of initial penetrations that count as none, at the start of the step and at its end.
  double allowed_part_n = 1., allowed_part = 1.;
  bool is_removed = false; ///< nothing touches the tool any longer

  /// Returns the gap offset of a node, by which the tool's surface counts as raised [length].
  double gap_offset(const ContactPoint &node) const {
    return node.multiplier_offset - InitialOverlap::counted(node.initial_penetration, allowed_part);
  }
};

} // namespace billet

#endif
