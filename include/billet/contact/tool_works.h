// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_WORKS_H
#define BILLET_CONTACT_TOOL_WORKS_H

#include "billet/contact/contact_load.h"
#include "billet/contact/step_works.h"
#include "billet/contact/tool_springs.h"

namespace billet {

/// Loads, energies and works of contact with a tool in the step, at the last update().
class ToolWorks {
public:
  /// The parts must outlive this object.
  explicit ToolWorks(const RigidContactParts &parts) : parts_(parts) {}

  /// Collective.
  ContactLoad compute_load() const;
  /// Computes the works as ContactMeasures::compute_step_works() does. Collective.
  StepWorks compute_step_works(double weight) const;

  /// Adds the contribution of a corner whose node touches, with its area at the facet. Returns the
  /// force on the body.
  template <bool is_explicit>
  dealii::Tensor<1, 3> add_corner(const ToolSprings<is_explicit> &springs, const ContactFacet &facet,
                                  unsigned int corner, double area, ContactLoad &load) const;
  /// Adds the dissipation of nodes that have lifted off, in explicit scenes with friction.
  void add_released(ContactLoad &load) const;

private:
  template <bool is_explicit>
  ContactLoad local_load(const ToolSprings<is_explicit> &springs, bool hands_over) const;
  /// Calls visit(account, area_n, area) for the corners of all facets.
  template <class Visit> void visit_friction(bool hands_over, const Visit &visit) const;
  /// Whether any node presses at the start of the step, and any at the last update(). Collective.
  bool presses_at_both_ends() const;
  /// Whether a node has entered or left within the step, or the allowed part of its penetration
  /// changes.
  bool has_moved() const;
  void add_pressure_works(double weight, StepWorks &works) const;
  /// Returns the area of each node from the facets of this rank, projected along these normals.
  template <class NormalOf> std::vector<double> areas_along(const NormalOf &normal_of) const;

  const RigidContactParts &parts_;
};

} // namespace billet

#endif
