// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_CONTACT_H
#define BILLET_CONTACT_FACET_CONTACT_H

#include "billet/contact/contact_load.h"
#include "billet/contact/edge_contact.h"
#include "billet/contact/facet_overlaps.h"
#include "billet/contact/facet_sharing.h"
#include "billet/contact/slave_traction.h"
#include "billet/contact/status_changes.h"
#include "billet/contact/step_works.h"
#include "billet/contact/supporting_point.h"
#include "billet/contact/surface_exchange.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/state.h"
#include "billet/usage.h"

#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

namespace billet {

/// How a facet is seen by the nodes that touch it.
enum class FacetMethod {
  planed,   ///< PlanedFacet: no iteration
  mean_gap, ///< MeanGapFacet
  bilinear, ///< BilinearFacet: without friction, forces at a fixed area have a potential
  overlap   ///< FacetOverlapOf: no nodes, but facets touch, on their common polygon
};

/// The facets of FacetMethod::overlap, of which no node is projected.
struct OverlapFacet {};

/// Calls f(type), type::type being what a facet is to this method.
template <class Type> struct FacetType { using type = Type; };
template <class Function> void visit_method(const FacetMethod method, const Function &f) {
  switch (method) {
  case FacetMethod::planed:
    f(FacetType<PlanedFacet>());
    break;
  case FacetMethod::mean_gap:
    f(FacetType<MeanGapFacet>());
    break;
  case FacetMethod::bilinear:
    f(FacetType<BilinearFacet>());
    break;
  case FacetMethod::overlap:
    f(FacetType<OverlapFacet>());
    break;
  }
}

/// What contact between surfaces is made of.
struct FacetContactSettings {
  FacetMethod method = FacetMethod::planed;
  FrictionPointer friction; ///< null: none
  FacetSearch::Partners partners = FacetSearch::Partners::other_surfaces;
  /// Nodes of all surfaces are slaves, at half their penalty each, so that a pair of surfaces is as stiff as
  /// in one pass; else nodes of surface 0 only.
  bool two_pass = true;
  ContactLimits limits;
  double search_margin; ///< of FacetSearch, > 0 [length]
  /// Edges that are not flat are held apart where they cross, without friction, at the mean full penalty of
  /// the ends of both. Not asked for, this costs nothing.
  bool edges = false;
  double flat_edge = 0.99; ///< EdgeContact's largest alignment of normals
  double edge_depth = 5.;  ///< and its depth, relative to the facets' reach
  /// A node that is before a facet by no more than this part of its facets' size, now and at the start of the
  /// step, counts as touching it, without pressure: its stiffness may be all that holds a body at rest. < 0:
  /// none does.
  double touching_gap = -1.;
  /// How often a node may change facet or status in one step's iterations; one that did so more often stays
  /// with its facet as long as it touches that. 0: as often as it likes, and nobody counts.
  unsigned int most_changes = 0;
};

/// What contact between surfaces does in one step, over all ranks.
struct FacetContactLoad {
  dealii::Tensor<1, 3> force;           ///< on surface 0, by the others
  dealii::Tensor<1, 3> moment;          ///< the same about the origin [force length]
  double stored_energy = 0.;            ///< in the penalty springs [energy]
  double dissipation = 0.;              ///< by friction in this step [energy]
  double damping = 0.;                  ///< of its springs in this step, by FrictionAccount [energy]
  double area = 0.;                     ///< of slaves in contact, of both passes [length²]
  double n_touching = 0.;               ///< slave nodes; one that several ranks have counts on each
  double deepest = 0.;                  ///< largest penetration [length]
  double deepest_relative = 0.;         ///< the same, relative to the root of the facet's area
  double absolute_force = 0.;           ///< Σ |F|, the scale of what follows
  dealii::Tensor<1, 3> residual_force;  ///< Σ (F + Σ F_I): 0 but for round-off
  dealii::Tensor<1, 3> residual_moment; ///< the same of the moments [force length]
};

/// Contact between the surfaces of deformable bodies, or of one with itself, node against facet: slave nodes
/// are held out of facets by a penalty, with friction in a frame that each node carries along. The force on a
/// node is its traction times its share of its own facets' area; the facet's corners take the reaction, which
/// balances force and moment.
///
/// With overlaps, facet against facet: the gap of a slave node a is the mean over all polygons of its facets,
/// weighted by its function, g_a = Σ ∫ φ_a g dA/A_a with A_a = Σ ∫ φ_a dA; its traction t_a acts by the same
/// functions, F_b = Σ_a t_a ∫ φ_a φ_b dA on the slave's nodes and −Σ_a t_a ∫ φ_a ψ_I dA on the target's.
///
/// Plain arrays in and out: nodes and facets are those of this rank, facets of other ranks come by
/// SurfaceExchange. A node that several ranks have is a slave on each, with the area of that rank's facets;
/// its state is the same on all of them. Forces on it are to be summed over these ranks, as forces of
/// elements are.
class FacetContact {
public:
  using Positions = FacetSearch::Positions;

  /// `node_keys` and `facets` as SurfaceExchange wants them; of each node the full penalties as a slave, and
  /// the size of the facets around it.
  FacetContact(MPI_Comm communicator, const FacetContactSettings &settings,
               std::vector<std::uint64_t> node_keys, std::vector<SurfaceFacet> facets,
               std::vector<ContactStiffness> stiffness, std::vector<double> sizes);

  /// Adds contact forces at `positions` to `forces`; `positions_n` are those of the last commit(), and
  /// `duration` is the time in between. All are of this rank's nodes.
  void add_forces(const Positions &positions_n, const Positions &positions, double duration,
                  Positions &forces);

  /// Called with nodes i, j, ... of this rank and ghosts, and the matrix −∂F_c,i/∂x_j, three rows and columns
  /// a node [force/length].
  using AddTangent =
      std::function<void(const std::vector<unsigned int> &, const dealii::FullMatrix<double> &)>;
  /// The tangent of the last add_forces(): of each slave that touches, the part of this rank's area. Kinds as
  /// of compute_traction(); all but the exact and the numerical ones hold normals, areas and weights.
  void visit_tangents(ContactTangent kind, const AddTangent &add) const;

  /// Calls add(nodes) with the nodes of each block that visit_tangents() may call with until coupling facets
  /// change, and takes note of it.
  void visit_couplings(ContactTangent kind,
                       const std::function<void(const std::vector<unsigned int> &)> &add);
  /// Whether visit_tangents() has blocks of this rank that the last visit_couplings() did not name.
  bool has_new_couplings() const;
  /// What the last visit_couplings() took note of, in numbers, and back.
  std::vector<double> couplings() const;
  void set_couplings(const std::vector<double> &numbers);
  /// To bring data of own nodes to ghosts, and sums back.
  const SurfaceExchange &exchange() const { return exchange_; }

  /// Adds to each of this rank's nodes what bounds the time step, after add_forces(): the sum Σ_j |K_ij| of
  /// its row of the contact stiffness, 2 k A for a slave and 2 w_I k A for a facet's corner [force/length].
  /// With the same sum of the elements, ω² <= max_i Σ_j |K_ij|/m_i. A slave straight before one of its
  /// candidates counts as if it touched it: a step that were shortened only when a node has entered would be
  /// too long for that entry.
  void add_row_sums(std::vector<double> &row_sums);

  /// Adds those of this rank's areas, after add_forces() and before commit().
  void add_crossings(Crossings &crossings) const;

  /// After add_forces().
  FacetContactLoad compute_load() const;

  /// Of FrictionRule, by which friction is accounted for: ½ and false unless they are set.
  void set_friction_account(const double start_weight, const bool is_static) {
    start_weight_ = start_weight;
    is_static_ = is_static;
  }

  /// By friction in this step, of this rank [energy].
  double local_dissipation() const;
  /// As RigidContact's, of slaves. Collective.
  StepWorks compute_step_works(double weight) const;

  /// Doubles of history on this rank.
  /// Of this rank's nodes, the largest penalty times the facets' size squared [force/length].
  double largest_spring() const;
  std::size_t history_size() const {
    return (touched_n_.size() * sizeof(TouchedFacet) + 2 * history_n_.size() * sizeof(SlaveHistory)) /
           sizeof(double);
  }

  /// The state of the last add_forces() becomes the start of the next step.
  void commit();

  /// Of undeformed surfaces, before anything else: nodes that are before a facet of the other one by no more
  /// than `within` count as touching it without pressure, from where they are, for good. Nodes of overlapping
  /// facets by their mean gap; what then is deeper than that, allow_initial_depths() allows. Collective.
  void close_initial_gaps(const Positions &positions, double within);
  /// How deep nodes are in facets at the last add_forces(), before the first commit(), is allowed: only what
  /// is deeper than a part of it counts from then on, at first all of it. What overlapping facets then still
  /// find is allowed by another call after another add_forces(). Returns the deepest that was new on this
  /// rank [facet sizes].
  double allow_initial_depths();
  /// That part at the start and the end of the step.
  void set_allowed_part(const double at_start, const double at_end) {
    allowed_part_n_ = at_start;
    allowed_part_ = at_end;
  }

  // The augmented Lagrangian by Uzawa's method: pressure p = k <a − g>, where the lift a takes up p/k, and in
  // the same way a sticking node's traction becomes what its spring starts from.

  /// Back to what the last commit() left: of a step that is tried, or tried anew.
  void restart();
  /// The augmentations since the last restart() or commit().
  void take_back_augmentation();
  /// Lifts and tractions become those of the last add_forces().
  void augment();
  /// The largest gap of a node that presses, and elastic slip of one that sticks, relative to the size of its
  /// facets; after add_forces(). On this rank.
  double augmentation_error() const;
  /// After add_forces(), of this rank's areas.
  ContactSprings compute_springs() const;
  /// Makes all penalties so many times as stiff; what augmentation holds stays. After augment().
  void stiffen(const double factor) { scale_penalties(factor, factor); }
  /// The same, with a factor of their own for the tangential ones.
  void scale_penalties(double normal, double tangential);
  /// As RigidContact's.
  void stiffen_under_load(double normal, double tangential);
  double stiffening() const { return stiffening_; } ///< so far
  double tangential_stiffening() const { return tangential_stiffening_; }
  /// How deep this rank's nodes are.
  Penetration penetration() const;
  /// The same, as part of the reach of the facets that they touch.
  double excessive_penetration() const;
  /// The most by which a node of this rank closes in the step that presses at its end and did not at its
  /// start, as part of the size of its facets.
  double closing_of_new_contacts() const;

  /// Calls visit(position, normal of the facet, surfaces of node and facet) for each slave that touches now.
  template <class Visit> void visit_touching(const Visit &visit) const {
    for (std::size_t s = 0; s < slaves_.size(); ++s)
      if (states_[s].presses())
        visit(positions_[slaves_[s].node], states_[s].contact.normal, slaves_[s].surface,
              search_.facets()[states_[s].touched.facet].surface);
  }

  /// The same of slaves and crossing edges as visit(SupportingPoint, surface of the point, surface of what it
  /// touches).
  template <class Visit> void visit_supporting(const Visit &visit) const {
    for (std::size_t s = 0; s < slaves_.size(); ++s)
      if (states_[s].presses())
        visit(make_supporting_point(positions_[slaves_[s].node], states_[s].contact.normal,
                                    settings_.friction.get(), states_[s].traction.status,
                                    states_[s].traction.traction),
              slaves_[s].surface, search_.facets()[states_[s].touched.facet].surface);
    for (const auto &crossing : crossings_)
      if (crossing.counted_gap() < 0.) {
        dealii::Tensor<1, 3> position;
        for (unsigned int i = 0; i < 2; ++i)
          position += crossing.weights[i] * positions_[crossing.nodes[i]];
        visit(make_supporting_point(position, crossing.normal, nullptr, ContactStatus::slip, {}),
              crossing.surfaces[0], crossing.surfaces[1]);
      }
  }
  /// Returns the status of each slave of this rank and its traction times its area, after add_forces().
  std::vector<SlaveForce> slave_forces() const;

  /// State of a slave node, for output.
  struct NodeReport {
    ContactStatus status = ContactStatus::open;
    double pressure = 0., gap = 0., slip = 0.;
    double area = 0.; ///< of all facets around it
    dealii::Tensor<1, 3> traction;
    double penetration = 0.;          ///< where it presses, as penetration() has it
    double tangential_stiffness = 0.; ///< 0 without friction [force/length³]
  };
  /// Of each of this rank's nodes.
  std::vector<NodeReport> report() const;

  const FacetSearch &search() const { return search_; }
  FacetMethod method() const { return settings_.method; }

  /// A node of this rank that has changed facet or status more often than it may since restart().
  struct Restless {
    dealii::Tensor<1, 3> position;
    unsigned int n_changes;
  };
  std::vector<Restless> find_restless() const;

  /// The state at the start of the step, by the keys of nodes and facets. The positions at the last commit()
  /// are the caller's.
  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  struct SlaveState {
    TouchedFacet touched;
    bool is_near = false; ///< touches nothing yet, but may soon
    /// Of what is touched or near: normal and gap, less the offset, and the facets, by index into shares_.
    SharedGap contact{dealii::Tensor<1, 3>(), 0.};
    std::size_t first_share = 0, end_of_shares = 0;
    SlaveTraction traction;
    double own_area = 0.; ///< of this rank's facets
    double area = 0.;     ///< of all
    bool rests = false;   ///< touches without pressing
    // By friction in this step, this rank's part [energy]:
    double dissipation = 0., damping = 0., taken_beyond = 0., missed = 0.;
    double dissipation_handed_over = 0.; ///< the first one by FrictionAccount::handed_over()

    bool presses() const { return touched.exists() && (contact.gap < 0. || rests); }
  };

  void update_search(const Positions &positions_n, const Positions &positions);
  void rebuild();
  /// States of the slaves, and their forces in nodal_forces_.
  template <class Facet, class Law> void evaluate(const Law &law, double duration);
  /// What slave s touches, or is near, and with which areas.
  template <class Facet> void find_contact(std::size_t s);
  void find_overlaps(std::size_t s);
  void count_changes();
  FacetLift lift(const std::size_t s) const {
    FacetLift lift;
    if (!lifts_.empty())
      lift.now = lifts_[s];
    if (!lifts_n_.empty())
      lift.at_start = lifts_n_[s];
    if (!initial_depths_.empty()) {
      lift.now -= InitialOverlap::counted(initial_depths_[s], allowed_part_);
      lift.at_start -= InitialOverlap::counted(initial_depths_[s], allowed_part_n_);
    }
    return lift;
  }
  /// The largest gap of facets that fit each other [length].
  double flush_gap(const std::size_t s) const { return 1e-9 * sizes_[s]; }
  /// What augmentation alone lifts slave s by.
  double augmentation(const std::size_t s) const { return lifts_.empty() ? 0. : lifts_[s]; }
  /// Whether what slave s touches was there at the start of the step: one that came in within the step does
  /// not go back to where it was before.
  bool was_touching(std::size_t s) const;
  /// What the friction of slave s starts from becomes what it is.
  void augment_friction(std::size_t s);
  /// Of a slave that sticks, in this step, or since its traction was augmented [length].
  double elastic_slip(std::size_t s) const;
  /// How many times its gap the lift of slave s grows by: the secant's, where the last augmentation closed a
  /// part of it. Where little area touches, the same lift closes less.
  double pace_of_augmentation(std::size_t s, double gap) const;
  void update_overlaps();
  /// What slave s holds against a share's facet: itself, or a point of its own facet.
  dealii::Tensor<1, 3> slave_point(std::size_t s, const FacetShare &share, const Positions &positions) const {
    return share.slave_facet == FacetShare::none
               ? positions[slaves_[s].node]
               : facet::interpolate(share.slave_weights,
                                    corners_of(search_.facets()[share.slave_facet], positions));
  }
  /// This rank's part of the area with which a share counts.
  double area_of(const SlaveState &state, const FacetShare &share) const {
    if (share.slave_facet == FacetShare::none)
      return share.share * state.own_area;
    return share.slave_facet < exchange_.n_own_facets() ? share.share * state.area : 0.;
  }
  /// What a share's force grows with for each depth, or more.
  double spring_area_of(const SlaveState &state, const FacetShare &share) const {
    const double area = area_of(state, share);
    return area > 0. ? std::max(area, share.area) : 0.;
  }
  /// Depths that count as none: small against those that stiff penalties leave [length].
  double depth_rounding(const std::size_t s) const { return 1e-12 * sizes_[s]; }
  /// Whether slave s was before this facet by no more than `on_it` at the start of the step, or behind it.
  bool is_resting(const TouchedFacet &below, std::size_t s, double on_it) const;
  SlaveMotion compute_motion(std::size_t s, double duration) const;
  /// The part of the facets around a slave that this rank owns.
  double own_part(std::size_t s) const;
  /// That of slave s, which does not press, against the facet that it touched at the start of the step.
  SlaveMotion compute_motion_after_contact(std::size_t s, double duration) const;
  /// As RigidContact's. Collective.
  bool presses_at_both_ends() const;
  /// Takes note of what friction has dissipated at slave s. Of a node that several ranks have, each takes the
  /// part of its facets, by their number.
  void account_for_friction(std::size_t s, const SlaveMotion &motion);
  /// The nodes on whose positions the forces of slave s depend, itself first.
  std::vector<unsigned int> collect_nodes(std::size_t s, bool with_own_facets) const;
  template <class Law>
  void add_closed_tangent(const Law &law, ContactTangent kind, std::size_t s, const AddTangent &add) const;
  /// Forces of slave s on these nodes, with the facets and the branches of its state, from their positions
  /// x_n and x.
  template <class Facet, class Law, class Number>
  std::vector<dealii::Tensor<1, 3, Number>>
  follow_forces(const Law &law, std::size_t s, const std::vector<unsigned int> &nodes,
                const std::vector<dealii::Tensor<1, 3, Number>> &x) const;
  template <class Facet, class Law>
  void add_exact_tangent(const Law &law, std::size_t s, const AddTangent &add) const;
  template <class Facet, class Law>
  void add_numerical_tangent(const Law &law, std::size_t s, const AddTangent &add) const;
  void compute_areas(std::size_t s, SlaveState &state) const;
  /// Calls visit(share, force on the slave, reaction on the corners) for each facet that slave s touches.
  template <class Visit> void visit_forces(std::size_t s, const Visit &visit) const;
  /// k of a crossing [pressure/length].
  double edge_stiffness(const EdgeContact::Crossing &crossing) const {
    double sum = 0.;
    for (const unsigned int node : crossing.nodes)
      sum += stiffening_ * edge_stiffness_[node];
    return 0.25 * sum;
  }
  void add_edges(FacetContactLoad &load) const;

  MPI_Comm communicator_;
  FacetContactSettings settings_;
  SurfaceExchange exchange_;
  FacetSearch search_;
  double largest_reach_ = 0.;
  std::vector<SlaveNode> slaves_;
  std::vector<double> sizes_; ///< of slaves
  std::vector<ContactStiffness> stiffness_,
      given_stiffness_;               ///< of slaves, in one of the passes; at the start
  Positions positions_n_, positions_; ///< with ghosts
  MovedFacets moved_{search_, positions_};
  std::vector<TouchedFacet> touched_n_;
  /// Of slaves at the start of the step, for compute_step_works().
  struct PressureHistory {
    double pressure = 0.; ///< [stress]
    double depth = 0.;    ///< [length]
    double area = 0.;     ///< of the facets of all ranks [length²]
    dealii::Tensor<1, 3> normal;
  };
  std::vector<PressureHistory> pressed_n_;
  std::vector<unsigned int> n_changes_;      ///< of slaves, if they are counted
  std::vector<std::uint64_t> seen_;          ///< the same: facet and status at the last add_forces()
  bool is_rebuilt_ = false;                  ///< lists were made anew for the last add_forces()
  bool has_started_ = false;                 ///< commit() has been called
  double duration_ = 0.;                     ///< of the last add_forces()
  std::vector<std::uint64_t> restored_keys_; ///< of facets touched, after load() and before facets are here
  std::vector<SlaveState> states_;
  std::vector<FacetShare> shares_;                ///< slave by slave
  std::vector<SlaveHistory> history_n_, history_; ///< with friction only
  std::vector<SlaveHistory> base_;      ///< what this step's tractions start from: history_n_, or augmented
  std::vector<double> lifts_n_, lifts_; ///< of slaves; empty as long as nothing is augmented
  struct Augmentation {
    double lift = 0., gap = 0.; ///< that it came from, and the gap that this left [length]
  };
  std::vector<Augmentation> last_augmentations_;        ///< of slaves, in this step
  double stiffening_ = 1., tangential_stiffening_ = 1.; ///< of the penalties as given
  double start_weight_ = 0.5;
  bool is_static_ = false;
  /// Of slaves; empty if none is allowed and no gap is closed; < 0: a gap that counts as closed.
  std::vector<double> initial_depths_;
  double allowed_part_ = 1., allowed_part_n_ = 1.;
  bool has_lifts_ = false; ///< augment() has been called
  /// The same of nodes with ghosts, for overlaps: what depths allow, and what augmentation lifts by.
  std::vector<double> nodal_lifts_, nodal_augmentations_;
  std::optional<FacetOverlaps> overlaps_;
  std::optional<EdgeContact> edges_;
  std::vector<double> edge_stiffness_; ///< full normal penalties of nodes, if there are edges
  std::vector<EdgeContact::Crossing> crossings_;
  /// Keys of the facets that a slave was coupled to by the last visit_couplings(), sorted.
  std::vector<std::vector<std::uint64_t>> coupled_;
  Positions nodal_forces_; ///< with ghosts, of one step
  std::vector<double> nodal_sums_;
  HeldMemory memory_{Capability::body_contact}, contact_memory_{Capability::contact},
      friction_memory_{Capability::friction}, self_memory_{Capability::self_contact},
      edge_memory_{Capability::edges}, augmentation_memory_{Capability::augmentation};
};

} // namespace billet

#endif
