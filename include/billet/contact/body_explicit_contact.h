// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_BODY_EXPLICIT_CONTACT_H
#define BILLET_CONTACT_BODY_EXPLICIT_CONTACT_H

#include "billet/contact/body_contact_parts.h"
#include "billet/contact/explicit_contact.h"

#include <vector>

namespace billet {

/// Contact between bodies in schemes without a matrix.
class BodyExplicitContact final : public ExplicitContact {
public:
  /// The parts must outlive this object.
  explicit BodyExplicitContact(BodyContactParts &parts) : parts_(parts) {}

  void update(const NodalVectors &displacements) override;
  /// Adds bounds with which impacts conserve energy.
  ContactLoad add_forces(NodalVectors &forces, NodalVectors &bounds) override;
  void add_crossings(Crossings &crossings) const override;
  void begin(const ContactStep &step, const NodalVectors &displacements) override;

private:
  /// Computes the positions of the surface nodes.
  void place(const NodalVectors &displacements, FacetSearch::Positions &positions) const;

  BodyContactParts &parts_;
  std::vector<double> row_sums_; ///< of one step
};

} // namespace billet

#endif
