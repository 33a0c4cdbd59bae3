// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_BODY_CONTACT_H
#define BILLET_CONTACT_BODY_CONTACT_H

#include "billet/contact/body_surfaces.h"
#include "billet/contact/contact_interface.h"

#include <memory>

namespace billet {

class BodyChecks;
class BodyCouplings;
class BodyMeasures;
class FacetContact;
class FacetPaths;

/// Contact pair of two bodies, or of one body with itself: FacetContact on the boundary facets and nodes of
/// this rank.
class BodyContact final : public ContactInterface {
public:
  BodyContact(const Scene &scene, std::size_t pair, const LocalNodes &nodes, ContactTangent tangent);
  ~BodyContact() override;

  ContactPenalties &penalties() override;
  const ContactPenalties &penalties() const override;
  const ContactMeasures &measures() const override;
  ContactCouplings &couplings() override;
  const ContactCouplings &couplings() const override;
  const ContactChecks &checks() const override;

  void start_step(const ContactStep &step) override;
  void set_friction_account(double start_weight, bool is_static) override;
  void restart() override;
  void commit() override;

  void update(const Vector &displacements) override;
  void add_forces(Vector &residual) const override;
  void set_tangent(ContactTangent tangent) override;
  void add_tangent(const TangentSystem &system) const override;
  /// Returns the part of a motion before a node of either body goes through the other's facets, see
  /// FacetPaths.
  double find_free_part(const ContactPath &path) const override;

  void update(const NodalVectors &displacements) override;
  /// Adds bounds with which impacts conserve energy.
  ContactLoad add_forces(NodalVectors &forces, NodalVectors &bounds) override;
  void add_crossings(Crossings &crossings) const override;

  /// Records the initial penetration if the scene allows it, after update(). Closes initial gaps if the scene
  /// requests it. Collective.
  void allow_overlap();

  void save(StateWriter &writer, const NodeKeys &keys) const override;
  void load(const StateReader &reader, const NodeKeys &keys) override;
  /// Also allows the existing overlap.
  void begin(const ContactStep &step, const Vector &displacements) override;
  void begin(const ContactStep &step, const NodalVectors &displacements) override;

private:
  /// Computes the positions of the surface nodes.
  void place(const NodalVectors &displacements, FacetSearch::Positions &positions) const;
  void place(const Vector &displacements, FacetSearch::Positions &positions) const;
  /// Computes contact at positions_ in a step of this duration [time]. Collective.
  void evaluate(double duration);

  const BodyPair &pair_;
  const LocalNodes &nodes_;
  const BodySurfaces surfaces_;
  std::unique_ptr<FacetContact> contact_;
  std::unique_ptr<BodyCouplings> couplings_;
  std::unique_ptr<BodyMeasures> measures_;
  std::unique_ptr<BodyChecks> checks_;
  std::unique_ptr<FacetPaths> paths_; ///< of implicit scenes
  FacetSearch::Positions positions_n_, positions_;
  FacetSearch::Positions forces_; ///< of one step, as row_sums_
  std::vector<double> row_sums_;
  double duration_ = 0.; ///< of the step [time]
};

} // namespace billet

#endif
