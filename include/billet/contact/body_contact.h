// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_BODY_CONTACT_H
#define BILLET_CONTACT_BODY_CONTACT_H

#include "billet/contact/body_surfaces.h"
#include "billet/contact/contact_interface.h"

#include <memory>

namespace billet {

class ContactBlocks;
class FacetContact;
class FacetPaths;

/// Contact pair of two bodies, or of one body with itself: FacetContact on the boundary facets and nodes of
/// this rank.
class BodyContact final : public ContactInterface {
public:
  BodyContact(const Scene &scene, std::size_t pair, const LocalNodes &nodes, ContactTangent tangent);
  ~BodyContact() override;

  void start_step(const ContactStep &step) override;
  void set_friction_account(double start_weight, bool is_static) override;
  void commit() override;

  void update(const Vector &displacements) override;
  void add_forces(Vector &residual) const override;
  void set_tangent(const ContactTangent tangent) override { tangent_ = tangent; }
  void add_tangent(const TangentSystem &system) const override;
  StepWorks compute_step_works(double weight) const override;
  /// Returns the part of a motion before a node of either body goes through the other's facets, see
  /// FacetPaths.
  double find_free_part(const ContactPath &path) const override;

  bool has_new_couplings() const override;
  void find_couplings() override;
  void add_foreign_dofs(dealii::IndexSet &dofs) const override;
  void add_couplings(SparsityPattern &pattern) const override;
  void save_couplings(StateWriter &writer) const override;
  bool load_couplings(const StateReader &reader) override;

  void update(const NodalVectors &displacements) override;
  /// Adds bounds with which impacts conserve energy.
  ContactLoad add_forces(NodalVectors &forces, NodalVectors &bounds) override;
  void add_crossings(Crossings &crossings) const override;

  void restart() override;
  void augment() override;
  void take_back_augmentation() override;
  ContactSprings compute_springs() const override;
  void scale_penalties(double normal, double tangential) override;
  void stiffen_under_load(double normal, double tangential) override;
  double stiffening() const override;
  double tangential_stiffening() const override;
  double largest_spring() const override;

  Penetration penetration() const override;
  double excessive_penetration() const override;
  double closing_of_new_contacts() const override;
  /// Returns the load on the first body by the second.
  ContactLoad compute_load() const override;
  std::vector<SlaveForce> slave_forces() const override;
  /// Reports the slave nodes.
  std::vector<ContactNodeReport> report() const override;
  std::size_t history_size() const override;
  void add_resistances(std::size_t body, std::vector<Resistance> &resistances) const override;
  void visit_supporting(const VisitSupporting &visit) const override;

  std::string describe_restless() const override;
  std::string describe_obstacle() const override;

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
  double augmentation_gap() const override;
  /// Returns the numbers on which the couplings depend, apart from the positions of the nodes.
  std::vector<double> describe_couplings() const;

  const BodyPair &pair_;
  const LocalNodes &nodes_;
  const BodySurfaces surfaces_;
  std::unique_ptr<FacetContact> contact_;
  std::unique_ptr<ContactBlocks> blocks_;
  std::unique_ptr<FacetPaths> paths_; ///< of implicit scenes
  FacetSearch::Positions positions_n_, positions_;
  FacetSearch::Positions forces_; ///< of one step, as row_sums_
  std::vector<double> row_sums_;
  ContactTangent tangent_;
  double duration_ = 0.; ///< of the step [time]
};

} // namespace billet

#endif
