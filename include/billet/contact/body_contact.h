// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_BODY_CONTACT_H
#define BILLET_CONTACT_BODY_CONTACT_H

#include "billet/contact/contact_load.h"
#include "billet/contact/facet_contact.h"
#include "billet/contact/facet_paths.h"
#include "billet/discretization/local_nodes.h"
#include "billet/discretization/node_keys.h"
#include "billet/discretization/supports.h"
#include "billet/scene/rigid_motions.h"

#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <memory>

namespace billet {

/// Contact of a scene's two bodies, or of one with itself: FacetContact on the boundary facets and nodes of
/// this rank.
class BodyContact {
public:
  BodyContact(const Scene &scene, std::size_t pair, const LocalNodes &nodes);

  /// Adds F_c [force] at these displacements, `duration` after those of the last commit(), and to component 0
  /// of `bounds` what bounds the stiffness at a node, and more, so that impacts keep their energy
  /// [force/length]. Collective.
  void add_forces(const NodalVectors &displacements, double duration, NodalVectors &forces,
                  NodalVectors &bounds);

  // The same for schemes with a matrix:

  /// Computes gaps and tractions at `displacements` (ghosted), `duration` after those of the last commit().
  /// Collective.
  void update(const Vector &displacements, double duration);
  /// Adds −F_c [force] to `residual` (additive vector), after update().
  void add_forces(Vector &residual) const;
  /// Adds −∂F_c/∂u [force/length], after update(). Collective.
  void add_tangent(const TangentSystem &system, ContactTangent kind) const;
  /// The next update() is at time t, after a step from t_n on: bodies that start in each other part as the
  /// scene says.
  void start_step(double t_n, double t);
  /// As FacetContact's.
  void set_friction_account(const double start_weight, const bool is_static) {
    contact_->set_friction_account(start_weight, is_static);
  }
  /// Of the augmented Lagrangian, as FacetContact's. The error is on this rank, relative to what the pair
  /// asks for; 0 if it asks for none.
  void restart() { contact_->restart(); }
  void augment() { contact_->augment(); }
  void take_back_augmentation() { contact_->take_back_augmentation(); }
  double augmentation_error() const {
    const double tolerance = pair_.penetration_tolerance.value_or(0.);
    return tolerance > 0. ? contact_->augmentation_error() / tolerance : 0.;
  }

  /// Of this rank's nodes.
  ContactSprings compute_springs() const { return contact_->compute_springs(); }

  /// As RigidContact's.
  void stiffen(const double factor) { contact_->stiffen(factor); }
  void scale_penalties(const double normal, const double tangential) {
    contact_->scale_penalties(normal, tangential);
  }
  void stiffen_under_load(const double normal, const double tangential) {
    contact_->stiffen_under_load(normal, tangential);
  }
  double stiffening() const { return contact_->stiffening(); } ///< so far
  double stiffening_left() const { return most_stiffening_ / contact_->stiffening(); }
  double tangential_stiffening_left() const {
    return most_tangential_stiffening_ / contact_->tangential_stiffening();
  }
  /// As RigidContact::penetration().
  Penetration penetration() const { return contact_->penetration(); }
  double excessive_penetration() const { return contact_->excessive_penetration(); }
  double closing_of_new_contacts() const { return contact_->closing_of_new_contacts(); }
  const BodyPair &settings() const { return pair_; }
  const std::string &name() const { return pair_.name; }
  /// The part of the motion from these displacements to those (ghosted) in which no node of either body goes
  /// through the other's facets, see FacetPaths. Collective.
  double find_free_part(const Vector &from, const Vector &to, bool is_thorough);

  /// A sentence about nodes that keep changing facet or status; empty if there are none. Collective.
  std::string describe_restless() const;

  /// Whether add_tangent() has entries of this rank that the last add_couplings() did not name.
  bool has_new_couplings() const { return contact_->has_new_couplings(); }
  /// Finds which nodes add_tangent() may couple, after update(). Collective.
  void find_couplings(ContactTangent kind);
  /// Adds the dofs whose rows add_tangent() writes to.
  void add_foreign_dofs(dealii::IndexSet &dofs) const;
  /// Adds the entries that add_tangent() writes.
  void add_couplings(dealii::TrilinosWrappers::SparsityPattern &pattern) const;

  /// Adds what the other body does where it touches this one on this rank; none of a body that touches
  /// itself.
  void add_resistances(std::size_t body, std::vector<Resistance> &resistances) const;

  /// Calls visit(SupportingPoint, body of the point, body that it touches) for what touches on this rank;
  /// nothing of a body that touches itself.
  template <class Visit> void visit_supporting(const Visit &visit) const {
    if (pair_.bodies[0] != pair_.bodies[1])
      contact_->visit_supporting(
          [&](const SupportingPoint &point, const unsigned int of, const unsigned int on) {
            visit(point, pair_.bodies[of], pair_.bodies[on]);
          });
  }

  /// If the scene allows the undeformed bodies to be in each other, takes note of how deep they are, after
  /// update(); and closes gaps, if the scene asks for that. Collective.
  void allow_overlap();
  /// The same at these displacements.
  void allow_overlap(const NodalVectors &displacements);

  /// The state of the last add_forces() becomes the start of the next step.
  void commit();

  /// On the first body, by the second; after add_forces(). Collective.
  ContactLoad compute_load() const;
  /// Adds this rank's, after add_forces() and before commit().
  void add_crossings(Crossings &crossings) const { contact_->add_crossings(crossings); }
  /// By friction in this step, of this rank [energy].
  double local_dissipation() const { return contact_->local_dissipation(); }

  /// As RigidContact's.
  StepWorks compute_step_works(const double weight) const { return contact_->compute_step_works(weight); }

  std::vector<SlaveForce> slave_forces() const { return contact_->slave_forces(); }
  /// Of this rank's nodes that are slaves.
  std::vector<ContactNodeReport> report() const;
  std::size_t history_size() const { return contact_->history_size(); }
  /// Of this rank's nodes, the largest penalty times the facets' size squared [force/length].
  double largest_spring() const { return contact_->largest_spring(); }

  /// The state at the start of the step.
  void save(StateWriter &writer) const;
  void load(const StateReader &reader);
  /// In place of load(), for a pair that is new at these displacements.
  void begin(const NodalVectors &displacements);
  /// The same of ghosted displacements; then update() and allow_overlap() make the start. Collective.
  void begin(const Vector &displacements);
  /// What the last find_couplings() found: with another matrix pattern a run would not go on bit by bit.
  void save_couplings(StateWriter &writer) const;
  /// In place of find_couplings(). False, on all ranks, if that was on other ranks, or for another tangent.
  bool load_couplings(const StateReader &reader, ContactTangent kind);

private:
  void collect(const NodeKeys &keys);
  FacetContact::Positions positions_at(const NodalVectors &displacements) const;
  FacetContact::Positions positions_at(const Vector &displacements) const;
  std::vector<ContactStiffness> compute_stiffness(const Scene &scene);
  template <class DisplacementOf> void update(const DisplacementOf &displacement_of, double duration);
  /// Of surface nodes and ghosts. Collective.
  std::vector<std::array<DofIndex, 3>> find_all_dofs() const;
  std::vector<double> first_dofs() const;
  /// What decides on the couplings, besides where the nodes are.
  std::vector<double> describe_couplings(ContactTangent kind) const;

  const BodyPair &pair_;
  const LocalNodes &nodes_;
  std::vector<std::uint64_t> keys_;       ///< of each surface node
  std::vector<unsigned int> local_nodes_; ///< of each surface node
  std::vector<unsigned int> surface_of_;  ///< which of the two bodies it belongs to
  std::vector<double> sizes_;             ///< of the undeformed facets around it
  std::vector<double> penalty_lengths_;   ///< penalty_length() there
  std::vector<SurfaceFacet> facets_;
  std::vector<double> areas_;  ///< of the undeformed facets
  std::vector<double> depths_; ///< that nodes must not exceed on their ways, by facet
  /// Until penalties, the normal and the tangential ones, are 10 E/h.
  double most_stiffening_ = std::numeric_limits<double>::infinity(),
         most_tangential_stiffening_ = std::numeric_limits<double>::infinity();
  std::unique_ptr<FacetContact> contact_;
  std::unique_ptr<FacetPaths> paths_; ///< of implicit scenes
  FacetContact::Positions positions_n_, positions_;
  FacetContact::Positions forces_; ///< of one step, as row_sums_
  std::vector<double> row_sums_;
  std::vector<std::vector<DofIndex>> couplings_; ///< dofs of nodes that are coupled all with all, ascending
  ContactTangent coupled_kind_ = ContactTangent::exact; ///< for which
};

} // namespace billet

#endif
