// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_SPRINGS_H
#define BILLET_CONTACT_TOOL_SPRINGS_H

#include "billet/contact/rigid_contact_parts.h"
#include "billet/contact/spring_energy.h"

#include <cmath>

namespace billet {

/// Calls visit(facet, corner, its area) for each corner whose node touches the tool.
template <class Visit> void visit_touching(const RigidContactParts &parts, const Visit &visit) {
  for (const auto &facet : parts.slaves.facets) {
    const CornerStates states = parts.states_of(facet);
    if (!any_touches(states))
      continue;
    const ProjectedAreas areas = compute_projected_areas(states, false);
    for (unsigned int a = 0; a < 4; ++a)
      if (states[a]->status != ContactStatus::open)
        visit(facet, a, areas.areas[a]);
  }
}

/// Calls add(index of the slave node, its area at one facet) for nodes that touch the tool.
template <class Add> void visit_areas(const RigidContactParts &parts, const Add &add) {
  visit_touching(parts, [&](const ContactFacet &facet, const unsigned int corner, const double area) {
    if (area > 0.)
      add(facet.nodes[corner], area);
  });
}

/// Returns the maximum penetration up to which the spring energy acts on current areas in explicit
/// scenes. The excess acts on a fixed area: that of the last step in which the node was not so
/// deep. The limit is 0 for hardening springs, so that energy is conserved where the normal jumps,
/// as at an edge of the tool.
inline double penetration_on_current_areas(const ContactPoint &node) {
  constexpr double part_of_spacing = 0.1;
  return std::isinf(node.hardening_penetration) ? part_of_spacing * node.spacing : 0.;
}

/// Energies in the penalty springs of nodes on a tool, and the areas on which they act. These are
/// those of the last update(), and in explicit scenes also earlier ones (T7).
template <bool is_explicit> class ToolSprings {
public:
  /// The parts must outlive this object.
  explicit ToolSprings(const RigidContactParts &parts)
      : parts_(parts), stores_tangentially_(!parts.pair.is_augmented()) {}

  /// Returns the energy in the springs of a node that touches [energy/length²].
  double stored_energy(const std::size_t i) const {
    // Multipliers do not stretch springs.
    const ContactPoint &node = parts_.slaves.nodes[i];
    // The allowed penetration does not count.
    const double gap = parts_.states[i].gap + node.multiplier_offset;
    return parts_.states[i].share * node.spring().energy(gap) +
           (stores_tangentially_ ? parts_.states[i].tangential_energy : 0.);
  }
  SpringEnergy of(const std::size_t i, const double energy) const {
    if constexpr (is_explicit) {
      const ContactPoint &node = parts_.slaves.nodes[i];
      return SpringEnergy::split(energy, node.spring().energy(penetration_on_current_areas(node)));
    } else
      return SpringEnergy::on_one_area(energy);
  }
  SpringEnergy of(const std::size_t i) const { return of(i, stored_energy(i)); }

  /// Calls add(index of the slave node, area) with the area that multiplies tractions to give the
  /// force.
  template <class Add> void visit_counted_areas(const Add &add) const {
    visit_touching(parts_, [&](const ContactFacet &facet, const unsigned int corner, const double area) {
      const double counted = of(facet.nodes[corner]).counted_area(area, facet.shallow_areas[corner]);
      if (counted > 0.)
        add(facet.nodes[corner], counted);
    });
  }

private:
  const RigidContactParts &parts_;
  const bool stores_tangentially_;
};

/// Returns use(ToolSprings) of the scheme, chosen once for a loop over nodes.
template <class Use> auto with_tool_springs(const RigidContactParts &parts, const Use &use) {
  return parts.is_explicit ? use(ToolSprings<true>(parts)) : use(ToolSprings<false>(parts));
}

} // namespace billet

#endif
