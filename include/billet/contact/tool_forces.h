// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_FORCES_H
#define BILLET_CONTACT_TOOL_FORCES_H

#include "billet/contact/tool_bounds.h"
#include "billet/contact/tool_works.h"

namespace billet {

/// Forces of contact with a tool in explicit scenes, at the last update(). They include the
/// resistance of springs to changes of their areas, F_b = −Σ_a ê_a ∂A_a/∂x_b (T7). ê is the part of
/// the stored energy e that acts on current areas. Normal forces at any penetration then have the
/// potential Σ A_a ê_a + A_a0 (e_a − ê_a).
class ToolForces {
public:
  /// The parts must outlive this object.
  explicit ToolForces(RigidContactParts &parts)
      : parts_(parts), springs_(parts), works_(parts), bounds_(parts) {}

  /// Adds forces and bounds as ExplicitContact::add_forces() does, and records the areas of nodes
  /// that go deep. Returns the load of this rank's facets.
  ContactLoad add(NodalVectors &forces, NodalVectors &bounds);

private:
  /// Energies on current areas of a facet's corners that touch, with bounds of their springs.
  struct CornerSprings {
    std::array<double, 4> energies{};
    double penetration = 0.; ///< of the corner with the maximum energy [length]
    double hardening = 1.;   ///< of the stiffest spring
  };
  CornerSprings stretch(ContactFacet &facet, const CornerStates &states) const;
  /// Areas of the corners, and −Σ_a ê_a ∂A_a/∂x_b.
  struct CornerForces {
    std::array<double, 4> areas{};
    std::array<dealii::Tensor<1, 3>, 4> by_area;
  };
  static CornerForces resist(const CornerStates &states, const std::array<double, 4> &energies);
  void add_facet(ContactFacet &facet, NodalVectors &forces, NodalVectors &bounds, ContactLoad &load) const;

  RigidContactParts &parts_;
  ToolSprings<true> springs_;
  ToolWorks works_;
  ToolBounds bounds_;
};

} // namespace billet

#endif
