// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_PENALTIES_H
#define BILLET_CONTACT_FACET_PENALTIES_H

#include "billet/contact/contact_penalties.h"
#include "billet/contact/facet_contact_parts.h"
#include "billet/contact/facet_measures.h"

namespace billet {

/// Penalties of contact between surfaces, and the augmented Lagrangian by Uzawa's method, see
/// MultiplierOffsets. Likewise, the spring of a sticking node starts from its augmented traction.
class FacetPenalties final : public ContactPenalties {
public:
  /// The parts and their measures must outlive this object.
  FacetPenalties(FacetContactParts &parts, const FacetMeasures &measures);

  void augment() override;
  void take_back_augmentation() override;
  /// Computes the spring forces with this rank's areas.
  ContactSprings compute_springs() const override;

  void scale(double normal, double tangential) override;
  void scale_under_load(double normal, double tangential) override;
  double stiffening() const override { return parts_.penalties.stiffening(); }
  double tangential_stiffening() const override { return parts_.penalties.tangential_stiffening(); }
  double max_spring() const override;

private:
  double augmentation_gap() const override;
  /// Returns the elastic slip of each slave; 0 without friction [length].
  std::vector<double> elastic_slips() const;

  FacetContactParts &parts_;
  const FacetMeasures &measures_;
};

} // namespace billet

#endif
