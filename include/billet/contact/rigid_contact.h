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

/// Contact of boundary faces of a deformable body with a rigid tool. It uses nodal quadrature on current
/// areas, penalty pressure, and friction by return map in the contact frame of each slave node.
///
/// Each facet's share of a node's area is ∫ N_a <−ν·n> dξdη over the current facet, ν its outward area vector
/// and n the tool's normal. It is the facet's area projected along the tool's normal, weighted by the shape
/// function. On a flat contact this is one quarter of a parallelogram, as in the paper. On a general
/// quadrilateral it turns a uniform pressure into a uniform stress. A facet that does not face the tool (the
/// side of a billet, before it folds onto the die) has no share.
///
/// The pressure fades beyond the edge of the tool's surface, (T3), (T4). A node beyond the edge by d keeps
/// the part s(d) of its penalty, s = (1 − d²/w²)², w = 1/20 of the facets around it. The gradient of the
/// energy ½ k s g² per area pushes it outwards by −½ k g² s′ e, where e points away from the edge.
///
/// Where bodies have inertia, a node that is beyond the edge and deeper than w below the surface has missed
/// it. If it moves back in, it meets the back of the surface, which has no contact, until it comes out in
/// front again. Otherwise it would jump to its full penetration in a step or two and create energy. The rule
/// does not apply where another tool is near, nor to a part of the surface that the node approaches from the
/// front.
///
/// Facets between whose nodes the tool could enter undetected (FacetDivision) are divided, (T10): each into n
/// × m bilinear facets, whose interior corners are contact points like nodes. A point's position is Σ N_a x_a
/// of the facet's nodes, which take its force and its stiffness by the same N_a. All of the above applies to
/// the parts and their corners as it does to facets and nodes.
///
/// Every rank that owns a facet at a node stores and computes the same state of the node. Points inside
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
  /// Sets the placement of the tool at the end of the step.
  void set_placement(const Placement &to) { placement_ = to; }
  void commit() override;

  /// Removes the tool: from now on no node touches it.
  void remove_tool();

  void update(const Vector &displacements) override;
  void add_forces(Vector &residual) const override;
  void set_tangent(const ContactTangent tangent) override { tangent_ = tangent; }
  void add_tangent(const TangentSystem &system) const override;
  StepWorks compute_step_works(double weight) const override;
  /// Implemented in contact/tool_paths.cc.
  double find_free_part(const ContactPath &path) const override;
  /// Whether the tool is thinner than two facets: only then can nodes pass through it.
  bool may_let_nodes_through() const override { return thin_tool_.has_value(); }
  /// Valid after update() and before commit(); false in the first step after load().
  bool lets_nodes_through() const override;
  std::string describe_passage() const override;

  /// Adds the force of the tool on touching nodes that do not follow its motion to `after`, to first order.
  /// After update().
  void add_tool_push(const Placement &after, Vector &forces) const;

  /// A rigid motion of the tool: x moves by translation + rotation × (x − moved centre).
  struct ToolRate {
    dealii::Tensor<1, 3> translation, rotation;
  };
  /// Adds derivatives of the residual R and of the power of the tool, P = Σ F·v, for a rate of the tool. Adds
  /// ∂R/∂s to `column` and ∂P/∂u to `row` (additive vectors), and returns this rank's ∂P/∂s. They follow from
  /// K = −∂F_c/∂u and the invariance of F_c under rigid motions of node and tool together: with v_b the rate
  /// at node b and ω its rotation,
  ///   ∂F_a/∂s = ω × F_a + Σ_b K_ab v_b,   ∂P/∂u_b = −Σ_a v_a·K_ab + ω × F_b·,   ∂P/∂s = Σ_a v_a·∂F_a/∂s.
  double add_tool_derivatives(const ToolRate &rate, Vector &column, Vector &row) const;

  /// Measures of full sliding on this rank, at the last update() and a rate of the tool. `touching` and
  /// `slipping` are Σ A p |v_t| of the nodes that touch, or slip, v_t the rate along the tool's surface.
  /// `power_of_pressure` is the power of the pressure on the body, Σ A p v_n.
  struct Grip {
    double touching = 0., slipping = 0., power_of_pressure = 0.;
  };
  Grip grip(const ToolRate &rate) const;

  /// Returns the distance [length] that the tool must move along `direction` (unit) to touch a node of this
  /// rank, at the last update(). It is infinite if the tool cannot touch any.
  double distance_to_touch(const dealii::Tensor<1, 3> &direction) const;
  /// Links each tool contact of a scene to the others of its body: pressure does not fade where another tool
  /// continues. The addresses must stay valid.
  static void introduce(std::deque<RigidContact> &contacts);
  /// Whether the edge of the tool's surface is within a tenth of a facet of this rank's node at `position`.
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
  /// Returns the penetration relative to the acceptable one: a fifth of a facet, and 0.4 of the element
  /// behind the node.
  double excessive_penetration() const override;
  double closing_of_new_contacts() const override;
  ContactLoad compute_load() const override;
  std::vector<SlaveForce> slave_forces() const override;
  /// Reports every node at a facet of this rank; `area` is this rank's share. At divided facets, pressure,
  /// traction and status are means over all points that push the node, weighted by its share of their areas.
  std::vector<ContactNodeReport> report() const override;
  std::size_t history_size() const override;
  /// Adds the resistances; none if the tool is removed.
  void add_resistances(std::size_t body, std::vector<Resistance> &resistances) const override;
  void visit_supporting(const VisitSupporting &visit) const override;

  /// Returns a message if the tool fits between the contact points.
  DiagnosticList check_start() const override;
  /// Returns a message if nodes have been found behind the tool.
  DiagnosticList check_step() const override;
  std::string describe_obstacle() const override;

  // Schemes without a matrix, after bind():

  /// Finds the nodes of the pair among those of the rank.
  void bind(const LocalNodes &nodes);
  void update(const NodalVectors &displacements) override;
  /// Without friction F_c = −∂Π/∂u, Π the stored energy, including the forces due to changes of area.
  ContactLoad add_forces(NodalVectors &forces, NodalVectors &bounds) override;
  void add_crossings(Crossings &crossings) const override;
  void add_start_crossings(Crossings &crossings, const NodalVectors &velocities, double step) const override;
  double stiffness_against_tool() const override;

  void save(StateWriter &writer, const NodeKeys &keys) const override;
  void load(const StateReader &reader, const NodeKeys &keys) override;
  void begin(const ContactStep &step, const Vector &displacements) override;
  void begin(const ContactStep &step, const NodalVectors &displacements) override;

private:
  /// Returns the elastic slip of a sticking node in this step, or since its last augmentation [length].
  double elastic_slip(std::size_t i) const;
  /// History of a node, only with friction.
  struct FrictionHistory {
    bool is_active = false;
    Frame frame;
    std::array<double, 2> tangential{};
    dealii::Tensor<1, 3> tool_position; ///< of the slave node, in the tool's coordinates
    double slip = 0.;                   ///< length of the path slipped
    double slip_rate = 0.;
  };
  /// Limits of nodes that are about to touch: nearer than this part of their facets' size, or this many steps
  /// away.
  static constexpr double near_gap = 0.25, near_steps = 20.;
  /// Returns the gap offset of a node, by which the tool's surface counts as raised [length].
  double lift_of(const ContactPoint &node) const {
    return node.lift - InitialOverlap::counted(node.initial_depth, allowed_part_);
  }
  /// Returns the maximum stiffness of a node's normal spring at the end of the next step, if that has the
  /// same duration.
  double stiffness_ahead(std::size_t i) const;
  /// Whether a divided facet is too far from the tool for its interior points to touch. If so, releases them.
  bool is_far(DividedFacet &divided);
  void average_over_points(std::vector<ContactNodeReport> &reports) const;
  void save_nodes(StateWriter &writer, const SlaveSurface::Range &range) const;
  /// Areas of a facet's corners in checkpoints, and their names.
  using CornerAreas = std::array<double, 4> ContactFacet::*;
  using KeptAreas = std::pair<std::string, CornerAreas>;
  std::vector<KeptAreas> kept_areas() const;
  void save_areas(StateWriter &writer, const std::string &name, CornerAreas areas,
                  const SlaveSurface::Range &range) const;
  void load_nodes(const StateReader &reader, const SlaveSurface::Range &range);
  void load_areas(const StateReader &reader, const std::string &name, CornerAreas areas,
                  const SlaveSurface::Range &range);
  /// Stores the positions of nodes that might pass through a thin tool, for the next step.
  void remember_positions();
  /// Stores the pressures of the last update() for the works of the next step.
  void remember_pressures();
  /// Returns the area of each node from the facets of this rank, projected along these normals.
  template <class NormalOf> std::vector<double> areas_along(const NormalOf &normal_of) const;
  /// Whether a node at this position has missed the tool's surface.
  bool misses(const ContactPoint &node, const dealii::Tensor<1, 3> &position,
              const dealii::Tensor<1, 3> &on_tool, const RigidSurface::Projection &projection) const;
  /// Computes the state of node i at `position` and, with friction, its history.
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
  /// Calls add() with the area that multiplies pressures to give the force.
  template <class Add> void for_each_counted_area(const Add &add) const;
  /// Calls visit(facet, corner, its area) for each corner whose node touches.
  template <class Visit> void for_each_touching(const Visit &visit) const;
  /// Calls add(index of the slave node, area) for owned nodes that do not touch, but may soon do so.
  template <class Add> void for_each_near(const Add &add) const;
  /// Adds the contribution of a corner whose node touches, with its area at the facet. Returns the force on
  /// the body.
  dealii::Tensor<1, 3> add_to_load(ContactLoad &load, const ContactFacet &facet, unsigned int corner,
                                   double area) const;
  /// Whether another tool has a surface nearer than `near` at this position. If given, `facing` is the
  /// direction (in space) that it must face: a tool that presses the other side of a sheet does not count.
  bool is_near_another(const dealii::Tensor<1, 3> &position, double near,
                       const std::optional<dealii::Tensor<1, 3>> &facing = {}) const;
  /// Returns the energy in the penalty springs of a node that touches [energy/length²].
  double stored_energy(std::size_t i) const;
  SpringEnergy springs_of(std::size_t i, double energy) const;
  SpringEnergy springs_of(const std::size_t i) const { return springs_of(i, stored_energy(i)); }
  /// Adds the forces of a facet and their bounds. They include the resistance of springs to changes of their
  /// areas, F_b = −Σ_a ê_a ∂A_a/∂x_b (T7), with ê the part of the stored energy e that acts on current areas.
  /// Normal forces at any penetration then have the potential Σ A_a ê_a + A_a0 (e_a − ê_a).
  void add_forces(ContactFacet &facet, NodalVectors &forces, NodalVectors &bounds, ContactLoad &load);
  /// Adds the dissipation by friction. In explicit scenes, adds only that of nodes that have lifted off.
  void add_friction(ContactLoad &load, bool hands_over) const;
  /// Calls visit(account, area_n, area) for the corners of all facets.
  template <class Visit> void visit_friction(bool hands_over, const Visit &visit) const;
  /// Returns the contribution of this rank's facets to compute_load().
  ContactLoad local_load(bool hands_over) const;
  /// Whether any node presses at the start of the step, and any at the last update(). Collective.
  bool presses_at_both_ends() const;
  void add_released(ContactLoad &load) const;
  CornerStates states_of(const ContactFacet &facet) const;
  /// Computes −∂F_c/∂u of a facet's nodes, 12 × 12. Returns false if none of them touches.
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
  /// State of a node at the start of the step, in the tool's coordinates, for compute_step_works().
  struct PressureHistory {
    double pressure = 0.; ///< [stress]
    double depth = 0.;    ///< [length]
    dealii::Tensor<1, 3> normal, position;
  };
  std::vector<PressureHistory> pressed_n_;
  bool knows_pressures_ = false; ///< same on all ranks: pressed_n_ is that of the start of the step
  double allowed_part_n_ = 1.;   ///< at the start of the step
  std::vector<std::array<double, 2>>
      base_; ///< initial friction of this step: that of friction_n_, or augmented
  std::vector<const RigidContact *> others_; ///< of the same body
  std::vector<unsigned int> local_nodes_;    ///< of each node of the mesh, after bind()
  std::vector<bool> is_owned_;               ///< as in LocalNodes
  Placement placement_n_, placement_;
  double duration_ = 0.; ///< of the step [time]
  double allowed_part_ = 1.;
  double start_weight_ = 0.5;
  bool is_static_ = false;
  double tool_reach_ = 0.;
  std::optional<ThinToolWatch> thin_tool_;              ///< none unless the tool is thin on any rank
  double stiffening_ = 1., tangential_stiffening_ = 1.; ///< of the given penalties
  bool is_removed_ = false;
  bool has_nodes_behind_ = false;
  HeldMemory memory_{Capability::contact}, friction_memory_{Capability::friction},
      augmentation_memory_{Capability::augmentation};
};

} // namespace billet

#endif
