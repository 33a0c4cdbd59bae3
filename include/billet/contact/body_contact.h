// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_BODY_CONTACT_H
#define BILLET_CONTACT_BODY_CONTACT_H

#include "billet/contact/body_contact_parts.h"
#include "billet/contact/contact_interface.h"
#include "billet/contact/start_gaps.h"

#include <memory>

namespace billet {

class BodyChecks;
class BodyExplicitContact;
class BodyMatrixContact;
class BodyMeasures;

/// Contact pair of two bodies, or of one body with itself: FacetContact on the boundary facets and
/// nodes of this rank.
class BodyContact final : public ContactInterface {
public:
  /// Makes a pair for schemes with a matrix. `nodes` must outlive this object. Collective.
  BodyContact(const Scene &scene, std::size_t pair, const LocalNodes &nodes, ContactTangent tangent);
  /// Makes a pair for schemes without a matrix.
  BodyContact(const Scene &scene, std::size_t pair, const LocalNodes &nodes);
  ~BodyContact() override;

  MatrixContact &with_matrix() override;
  const MatrixContact &with_matrix() const override;
  ExplicitContact &without_matrix() override;
  const ExplicitContact &without_matrix() const override;
  ContactPenalties &penalties() override;
  const ContactPenalties &penalties() const override;
  const ContactMeasures &measures() const override;
  const ContactChecks &checks() const override;

  void start_step(const ContactStep &step) override;
  void set_friction_account(double start_weight, const FrictionAccounting &accounting) override;
  void restart() override;
  void commit() override;
  /// Records the initial penetration if the scene allows it, after update(). Closes initial gaps if
  /// the scene requests it. Collective.
  void allow_overlap() { parts_.allow_overlap(); }

  /// Returns what is to be judged of the gaps at the start. Collective.
  StartGaps start_gaps() const;

  void save(StateWriter &writer, const NodeKeys &keys) const override;
  void load(const StateReader &reader, const NodeKeys &keys) override;

private:
  BodyContact(const Scene &scene, const BodyPair &pair, const LocalNodes &nodes);

  BodyContactParts parts_;
  std::unique_ptr<BodyMeasures> measures_;
  std::unique_ptr<BodyChecks> checks_;
  std::unique_ptr<BodyMatrixContact> with_matrix_;      ///< null without a matrix
  std::unique_ptr<BodyExplicitContact> without_matrix_; ///< null with a matrix
};

} // namespace billet

#endif
