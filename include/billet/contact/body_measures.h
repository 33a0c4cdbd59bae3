// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_BODY_MEASURES_H
#define BILLET_CONTACT_BODY_MEASURES_H

#include "billet/contact/contact_measures.h"
#include "billet/discretization/local_nodes.h"
#include "billet/scene/scene.h"

namespace billet {

struct BodySurfaces;
class FacetContact;

/// Measures of contact between bodies: those of FacetContact, for bodies of the scene and dofs of
/// the mesh.
class BodyMeasures final : public ContactMeasures {
public:
  /// `surfaces` are those of `contact`. All must outlive this object.
  BodyMeasures(const BodyPair &pair, const LocalNodes &nodes, const BodySurfaces &surfaces,
               const FacetContact &contact)
      : pair_(pair), nodes_(nodes), surfaces_(surfaces), contact_(contact) {}

  Penetration penetration() const override;
  double excessive_penetration() const override;
  double closing_of_new_contacts() const override;
  double max_sliding(double expected) const override;
  FrictionUse friction_use() const override;
  /// Returns the load on the first body by the second.
  ContactLoad compute_load() const override;
  StepWorks compute_step_works(double weight) const override;
  std::vector<SlaveForce> slave_forces() const override;
  /// Reports the slave nodes.
  std::vector<ContactNodeReport> report() const override;
  std::size_t history_size() const override;
  void add_resistances(std::size_t body, std::vector<Resistance> &resistances) const override;
  void visit_supporting(const VisitSupporting &visit) const override;

private:
  /// Whether nodes of both surfaces are slaves.
  bool has_two_passes() const { return pair_.two_passes || pair_.is_self_contact; }

  const BodyPair &pair_;
  const LocalNodes &nodes_;
  const BodySurfaces &surfaces_;
  const FacetContact &contact_;
};

} // namespace billet

#endif
