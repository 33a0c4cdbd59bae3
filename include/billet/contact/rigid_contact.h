// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_RIGID_CONTACT_H
#define BILLET_CONTACT_RIGID_CONTACT_H

#include "billet/contact/contact_interface.h"
#include "billet/contact/edge_fading.h"
#include "billet/contact/hardening_spring.h"
#include "billet/contact/projected_areas.h"
#include "billet/contact/slave_surface.h"
#include "billet/contact/spring_energy.h"
#include "billet/contact/thin_tool_watch.h"
#include "billet/geometry/frame.h"
#include "billet/usage.h"

#include <deal.II/lac/full_matrix.h>

#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace billet {

/// Contact of boundary faces of a deformable body with a rigid tool: nodal quadrature on current areas, the
/// pressure by penalty, friction by return map in the contact frame of each slave node.
///
/// Each facet's share of a node's area is ∫ N_a <−ν·n> dξdη over the current facet, ν its outward area vector
/// and n the tool's normal: the facet's area seen along the tool's normal, weighted by the shape function. On
/// a flat contact this is one quarter of a parallelogram, as in the paper; on a general quadrilateral it is
/// what makes a uniform pressure a uniform stress, and a facet that does not face the tool (the side of a
/// billet, before it folds onto the die) has no share.
///
/// Where the tool's surface ends its pressure fades, (T3), (T4): a node beyond its border by d keeps the
/// part s(d) of its penalty, s = (1 − d²/w²)², w = 1/20 of the facets around it, and is pushed out by what
/// that takes of the energy ½ k s g² per area, −½ k g² s′ e, e pointing away from the border.
///
/// Where bodies have inertia, a node that is beyond the border and deeper than w below the surface there has
/// missed it: what it meets if it moves back in is the surface's back, which is none, until it comes out in
/// front again. It would jump to its full depth there, in a step or two, with energy from nowhere. Not where
/// another tool is near, nor of a part of the surface that it comes to from the front.
///
/// Facets between whose nodes the tool could enter unseen (FacetDivision) are divided, (T10): each into n × m
/// facets that are bilinear as well, whose corners inside are points of contact like nodes. A point's
/// position is Σ N_a x_a of the facet's nodes, which take its force and its stiffness by the same N_a. All of
/// the above holds for the parts as it stands: what they are to their corners is what facets are to nodes.
///
/// Node states are kept, and computed alike, on every rank that owns a facet at the node. Points inside
/// facets belong to one facet each, also those on its sides.
class RigidContact final : public ContactInterface {
public:
  RigidContact(const Scene &scene, std::size_t pair, const Discretization &discretization,
               ContactTangent tangent);

  std::size_t tool() const { return pair_.tool; }
  std::size_t body() const { return pair_.body; }

  void start_step(const ContactStep &step) override;
  void set_friction_account(const double start_weight, const bool is_static) override {
    start_weight_ = start_weight;
    is_static_ = is_static;
  }
  /// Changes where the tool moves to.
  void set_placement(const Placement &to) { placement_ = to; }
  void commit() override;

  /// The tool is gone: from now on no node touches it.
  void remove_tool();

  void update(const Vector &displacements) override;
  void add_forces(Vector &residual) const override;
  void set_tangent(const ContactTangent tangent) override { tangent_ = tangent; }
  void add_tangent(const TangentSystem &system) const override;
  StepWorks compute_step_works(double weight) const override;
  /// In contact/tool_paths.cc.
  double find_free_part(const ContactPath &path) const override;
  /// Of tools thinner than two facets, the only ones that nodes go through.
  bool may_let_nodes_through() const override { return thin_tool_.has_value(); }
  /// After update() and before commit(); false in the first step after load().
  bool lets_nodes_through() const override;
  std::string describe_passage() const override;

  /// Adds the force by which the tool, once it moves on to `after`, would push the nodes that touch it now if
  /// they stayed behind, to first order. After update().
  void add_tool_push(const Placement &after, Vector &forces) const;

  /// A rigid motion of the tool: x moves by translation + rotation × (x − moved centre).
  struct ToolRate {
    dealii::Tensor<1, 3> translation, rotation;
  };
  /// What a rate of the tool does to the residual, and to the power that the tool exerts by that rate, P = Σ
  /// F·v: ∂R/∂s into `column`, ∂P/∂u into `row` (additive vectors), ∂P/∂s returned, of this rank. By the
  /// invariance of F_c under rigid motions of node and tool together, from K = −∂F_c/∂u: with v_b the rate at
  /// node b and ω its rotation,
  ///   ∂F_a/∂s = ω × F_a + Σ_b K_ab v_b,   ∂P/∂u_b = −Σ_a v_a·K_ab + ω × F_b·,   ∂P/∂s = Σ_a v_a·∂F_a/∂s.
  double add_tool_derivatives(const ToolRate &rate, Vector &column, Vector &row) const;

  /// How friction holds the body on the tool, at the last update() and a rate of the tool: Σ A p |v_t| of the
  /// nodes that touch, and of those that slip, v_t the rate along the tool's surface, and the power of the
  /// pressure on the body, Σ A p v_n. On this rank.
  struct Grip {
    double touching = 0., slipping = 0., power_of_pressure = 0.;
  };
  Grip grip(const ToolRate &rate) const;

  /// How far the tool has to go along `direction` (unit) until it touches a node, at the last update();
  /// infinite if it cannot. On this rank.
  double distance_to_touch(const dealii::Tensor<1, 3> &direction) const;
  /// All of a scene, which stay where they are: pressure does not fade where another tool goes on.
  static void introduce(std::deque<RigidContact> &contacts);
  /// Whether a node that is there now has the border of the tool's surface within a tenth of a facet. Of this
  /// rank.
  bool has_node_on_border(const dealii::Tensor<1, 3> &position) const;
  /// Whether a node of this rank touches the tool, at the last update().
  bool has_touching_nodes() const;

  void restart() override;
  void take_back_augmentation() override { restart(); }
  void augment() override;
  ContactSprings compute_springs() const override;
  void scale_penalties(double normal, double tangential) override;
  void stiffen_under_load(double normal, double tangential) override;
  double stiffening() const override { return stiffening_; }
  double tangential_stiffening() const override { return tangential_stiffening_; }
  double largest_spring() const override;
  double surface_reach() const override { return tool_reach_; }

  Penetration penetration() const override;
  /// A fifth of a facet, and 0.4 of the element behind the node, are little enough.
  double excessive_penetration() const override;
  double closing_of_new_contacts() const override;
  ContactLoad compute_load() const override;
  std::vector<SlaveForce> slave_forces() const override;
  /// Of every node at a facet of this rank; `area` is this rank's share. At divided facets pressure, traction
  /// and status are those of all points that push the node, as means over its share of their areas.
  std::vector<ContactNodeReport> report() const override;
  std::size_t history_size() const override;
  /// None if the tool is removed.
  void add_resistances(std::size_t body, std::vector<Resistance> &resistances) const override;
  void visit_supporting(const VisitSupporting &visit) const override;

  /// A message on a tool that fits between the points of contact.
  DiagnosticList check_start() const override;
  /// A message if nodes have been found behind the tool.
  DiagnosticList check_step() const override;
  std::string describe_obstacle() const override;

  // Schemes without a matrix, after bind():

  /// Finds its nodes among those of the rank.
  void bind(const LocalNodes &nodes);
  void update(const NodalVectors &displacements) override;
  /// Without friction F_c = −∂Π/∂u, Π the stored energy: forces on areas that change are among them.
  ContactLoad add_forces(NodalVectors &forces, NodalVectors &bounds) override;
  void add_crossings(Crossings &crossings) const override;
  void add_start_crossings(Crossings &crossings, const NodalVectors &velocities, double step) const override;
  double stiffness_against_tool() const override;

  void save(StateWriter &writer, const NodeKeys &keys) const override;
  void load(const StateReader &reader, const NodeKeys &keys) override;
  void begin(const ContactStep &step, const Vector &displacements) override;
  void begin(const ContactStep &step, const NodalVectors &displacements) override;

private:
  /// Of a node that sticks, in this step, or since its traction was augmented [length].
  double elastic_slip(std::size_t i) const;
  /// Only with friction.
  struct FrictionHistory {
    bool is_active = false;
    Frame frame;
    std::array<double, 2> tangential{};
    dealii::Tensor<1, 3> tool_position; ///< of the slave node, in the tool's coordinates
    double slip = 0.;                   ///< length of the path slipped
    double slip_rate = 0.;
  };
  /// What is about to touch: nodes nearer than this part of their facets' size, or this many steps away.
  static constexpr double near_gap = 0.25, near_steps = 20.;
  /// By how much the tool's surface counts as raised for a node.
  double lift_of(const ContactPoint &node) const {
    return node.lift - InitialOverlap::counted(node.initial_depth, allowed_part_);
  }
  /// As stiff as the normal spring of a node may be at the end of the next step, if that is as long as this.
  double stiffness_ahead(std::size_t i) const;
  /// Sets points inside a divided facet free that is farther from the tool than they can matter; else false.
  bool is_far(DividedFacet &divided);
  void average_over_points(std::vector<ContactNodeReport> &reports) const;
  void save_nodes(StateWriter &writer, const SlaveSurface::Range &range) const;
  /// Areas of a facet's corners that checkpoints keep, and under which name.
  using CornerAreas = std::array<double, 4> ContactFacet::*;
  using KeptAreas = std::pair<std::string, CornerAreas>;
  std::vector<KeptAreas> kept_areas() const;
  void save_areas(StateWriter &writer, const std::string &name, CornerAreas areas,
                  const SlaveSurface::Range &range) const;
  void load_nodes(const StateReader &reader, const SlaveSurface::Range &range);
  void load_areas(const StateReader &reader, const std::string &name, CornerAreas areas,
                  const SlaveSurface::Range &range);
  /// Of nodes that might go through it, for the next step.
  void remember_positions();
  /// Notes the pressures of the last update() for the works of the next step.
  void remember_pressures();
  /// The area that the facets of this rank give to each node, as seen along these normals.
  template <class NormalOf> std::vector<double> areas_along(const NormalOf &normal_of) const;
  /// Whether a node there has missed the tool's surface.
  bool misses(const ContactPoint &node, const dealii::Tensor<1, 3> &position,
              const dealii::Tensor<1, 3> &on_tool, const RigidSurface::Projection &projection) const;
  /// The state of node i at `position`; with friction, the history that goes with it.
  template <class Law>
  ToolContactState evaluate(const Law &law, std::size_t i, const dealii::Tensor<1, 3> &position,
                            FrictionHistory *history) const;
  void apply_friction(const FrictionLaw &law, const ContactPoint &node, ToolContactState &state,
                      const EdgeFading *fading, const FrictionHistory &history_n,
                      FrictionHistory &history) const;
  FrictionRule friction_rule(const ContactPoint &node) const;
  /// Evaluates all nodes, each displaced by displacement_of(index).
  template <class DisplacementOf> void update_states(const DisplacementOf &displacement_of);
  template <class DisplacementOf>
  void begin_at(const ContactStep &step, const DisplacementOf &displacement_of);
  double augmentation_gap() const override;
  /// Calls add(index of the slave node, its area at one facet).
  template <class Add> void for_each_area(const Add &add) const;
  /// The same with the area on which the force stands: times pressures it is the force.
  template <class Add> void for_each_counted_area(const Add &add) const;
  /// Calls visit(facet, corner, its area) for each corner whose node touches.
  template <class Visit> void for_each_touching(const Visit &visit) const;
  /// Calls add(index of the slave node, area) for owned nodes that do not touch, but soon may.
  template <class Add> void for_each_near(const Add &add) const;
  /// Of a corner whose node touches, with its area at the facet; the force on the body.
  dealii::Tensor<1, 3> add_to_load(ContactLoad &load, const ContactFacet &facet, unsigned int corner,
                                   double area) const;
  /// Whether another tool has a surface there, nearer than `near`; one that is `facing` like this (in space),
  /// if that is given: one that presses the other side of a sheet does not.
  bool is_near_another(const dealii::Tensor<1, 3> &position, double near,
                       const std::optional<dealii::Tensor<1, 3>> &facing = {}) const;
  /// In the penalty springs of a node that touches [energy/length²].
  double stored_energy(std::size_t i) const;
  SpringEnergy springs_of(std::size_t i, double energy) const;
  SpringEnergy springs_of(const std::size_t i) const { return springs_of(i, stored_energy(i)); }
  /// Of a facet, with the forces by which springs resist a change of the areas that they stand on, F_b =
  /// −Σ_a ê_a ∂A_a/∂x_b (T7), ê what areas as they are weigh of the stored energy e: with these, normal
  /// forces at any depth have the potential Σ A_a ê_a + A_a0 (e_a − ê_a). And what they add to bounds.
  void add_forces(ContactFacet &facet, NodalVectors &forces, NodalVectors &bounds, ContactLoad &load);
  /// Adds what friction has dissipated. In explicit scenes, only that of nodes that have lifted off.
  void add_friction(ContactLoad &load, bool hands_over) const;
  /// Calls visit(account, area_n, area) for the corners of all facets.
  template <class Visit> void visit_friction(bool hands_over, const Visit &visit) const;
  /// What the facets of this rank contribute to compute_load().
  ContactLoad local_load(bool hands_over) const;
  /// Whether any node presses at the start of the step, and any at the last update(). Collective.
  bool presses_at_both_ends() const;
  void add_released(ContactLoad &load) const;
  CornerStates states_of(const ContactFacet &facet) const;
  /// −∂F_c/∂u of a facet's nodes, 12 × 12; false if none of them touches.
  bool compute_facet_tangent(const ContactFacet &facet, dealii::FullMatrix<double> &matrix) const;
  void add_divided_tangent(const DividedFacet &divided, const TangentSystem &system) const;
  void add_closed_tangent(const ContactFacet &facet, dealii::FullMatrix<double> &matrix) const;
  void add_numerical_tangent(const ContactFacet &facet, dealii::FullMatrix<double> &matrix) const;

  const ContactPair &pair_;
  const Tool &tool_;
  const MPI_Comm communicator_;
  ContactTangent tangent_;
  const bool has_inertia_;
  const bool is_explicit_; ///< works are those of the trapezoidal rule
  SlaveSurface slaves_;
  std::vector<ToolContactState> states_; ///< at the last update()
  std::vector<FrictionHistory> friction_n_, friction_;
  /// Of nodes at the start of the step, in the tool's coordinates, for compute_step_works().
  struct PressureHistory {
    double pressure = 0.; ///< [stress]
    double depth = 0.;    ///< [length]
    dealii::Tensor<1, 3> normal, position;
  };
  std::vector<PressureHistory> pressed_n_;
  bool knows_pressures_ = false; ///< all ranks alike: pressed_n_ is that of the start of the step
  double allowed_part_n_ = 1.;   ///< at the start of the step
  std::vector<std::array<double, 2>>
      base_; ///< what this step's friction starts from: that of friction_n_, or augmented
  std::vector<const RigidContact *> others_; ///< of the same body
  std::vector<unsigned int> local_nodes_;    ///< of each node of the mesh, after bind()
  std::vector<bool> is_owned_;               ///< as LocalNodes has it
  Placement placement_n_, placement_;
  double duration_ = 0.; ///< of the step [time]
  double allowed_part_ = 1.;
  double start_weight_ = 0.5;
  bool is_static_ = false;
  double tool_reach_ = 0.;
  std::optional<ThinToolWatch> thin_tool_;              ///< none unless the tool is thin on any rank
  double stiffening_ = 1., tangential_stiffening_ = 1.; ///< of the penalties as given
  bool is_removed_ = false;
  bool has_nodes_behind_ = false;
  HeldMemory memory_{Capability::contact}, friction_memory_{Capability::friction},
      augmentation_memory_{Capability::augmentation};
};

} // namespace billet

#endif
