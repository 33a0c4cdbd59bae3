// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_MEASURES_H
#define BILLET_CONTACT_TOOL_MEASURES_H

#include "billet/contact/contact_measures.h"
#include "billet/contact/start_gaps.h"
#include "billet/contact/tool_works.h"

namespace billet {

/// Measures and reports of contact with a tool.
class ToolMeasures final : public ContactMeasures {
public:
  /// The parts must outlive this object.
  explicit ToolMeasures(const RigidContactParts &parts) : parts_(parts), works_(parts) {}

  Penetration penetration() const override;
  FacetPenetration penetration_between_nodes() const override { return find_facet_penetration(parts_); }
  /// Returns the penetration relative to the acceptable one: a fifth of a facet, and 0.4 of the
  /// element behind the node.
  double excessive_penetration() const override;
  double closing_of_new_contacts() const override;
  double max_sliding(double expected) const override;
  FrictionUse friction_use() const override;
  ContactLoad compute_load() const override { return works_.compute_load(); }
  StepWorks compute_step_works(const double weight) const override {
    return works_.compute_step_works(weight);
  }
  std::vector<SlaveForce> slave_forces() const override;
  /// Reports every node at a facet of this rank; `area` is this rank's share. At divided facets,
  /// pressure, traction and status are means over all points that push the node, weighted by its
  /// share of their areas.
  std::vector<ContactNodeReport> report() const override;
  std::size_t history_size() const override;
  double surface_reach() const override { return parts_.tool_reach; }
  /// Adds the resistances; none if the tool is removed.
  void add_resistances(std::size_t body, std::vector<Resistance> &resistances) const override;
  void visit_supporting(const VisitSupporting &visit) const override;
  /// Returns what is to be judged of the gaps at the start.
  StartGaps start_gaps() const;
  /// Whether a node of this rank touches the tool.
  bool has_touching_nodes() const;

private:
  std::vector<ContactNodeReport> report_nodes() const;
  template <bool is_explicit>
  void add_areas(const ToolSprings<is_explicit> &springs, std::vector<ContactNodeReport> &reports) const;
  /// Raises curvatures to those along the sides of facets: there the tool's normal may change more
  /// than over the root of their area.
  void follow_sides(std::vector<ContactNodeReport> &reports) const;
  template <bool is_explicit>
  void average_over_points(const ToolSprings<is_explicit> &springs,
                           std::vector<ContactNodeReport> &reports) const;

  const RigidContactParts &parts_;
  ToolWorks works_;
};

} // namespace billet

#endif
