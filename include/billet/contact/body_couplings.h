// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_BODY_COUPLINGS_H
#define BILLET_CONTACT_BODY_COUPLINGS_H

#include "billet/contact/contact_blocks.h"
#include "billet/contact/contact_couplings.h"
#include "billet/contact/traction.h"
#include "billet/scene/scene.h"

#include <vector>

namespace billet {

struct BodySurfaces;

/// Couplings of the matrix by contact between bodies: the ContactBlocks of one kind of tangent.
class BodyCouplings final : public ContactCouplings {
public:
  /// `surfaces` are those of `contact`. All must outlive this object.
  BodyCouplings(const BodyPair &pair, const LocalNodes &nodes, const BodySurfaces &surfaces,
                FacetContact &contact, ContactTangent tangent);

  void set_tangent(const ContactTangent tangent) { tangent_ = tangent; }
  /// Adds −∂F_c/∂u [force/length]. Collective.
  void add_tangent(const TangentSystem &system) const { blocks_.add_tangent(tangent_, system); }

  bool has_new() const override { return blocks_.has_new(); }
  void find() override { blocks_.find(tangent_); }
  void add_foreign_dofs(dealii::IndexSet &dofs) const override { blocks_.add_foreign_dofs(dofs); }
  void add_entries(SparsityPattern &pattern) const override { blocks_.add_entries(pattern); }

  void save(StateWriter &writer) const override;
  bool load(const StateReader &reader) override;

private:
  /// Returns the numbers on which the couplings depend, apart from the positions of the nodes.
  std::vector<double> describe() const;

  const BodyPair &pair_;
  const BodySurfaces &surfaces_;
  ContactBlocks blocks_;
  ContactTangent tangent_;
};

} // namespace billet

#endif
