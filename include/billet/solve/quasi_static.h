// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_QUASI_STATIC_H
#define BILLET_SOLVE_QUASI_STATIC_H

#include "billet/contact/body_contact.h"
#include "billet/contact/rigid_contact.h"
#include "billet/forces/internal_forces.h"
#include "billet/solve/contact_losses.h"
#include "billet/solve/contact_stabilisation.h"
#include "billet/solve/error_control.h"
#include "billet/solve/implicit_motion.h"
#include "billet/solve/motion_watch.h"
#include "billet/solve/newton.h"
#include "billet/solve/penalty_control.h"
#include "billet/solve/penalty_watch.h"
#include "billet/solve/restart.h"
#include "billet/solve/rigid_body_support.h"
#include "billet/solve/round_off_watch.h"
#include "billet/solve/softness_limit.h"
#include "billet/solve/solution.h"
#include "billet/solve/step_energy.h"
#include "billet/solve/tangent_solver.h"
#include "billet/usage.h"

#include <Epetra_Map.h>
#include <Epetra_Vector.h>

#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace billet {

/// Equilibrium of all forces, R = F_int − F_c = 0, step by step: the sum of the parts as one nonlinear
/// problem, with commit on acceptance and nothing to undo on failure, since the state at the start of a step
/// is never written to. In scenes of implicit dynamics an ImplicitMotion makes the equation of motion of it.
class QuasiStatic final : public NonlinearProblem, public Solution {
public:
  QuasiStatic(const Scene &scene, const Discretization &discretization);

  /// Tries the step from the current time to `t`. On convergence the new state is committed. `previous_step`
  /// is the length of the last accepted step if its increment may be continued, 0 else. Throws
  /// SolutionFailure, on all ranks, where the removal of tools has left a body free.
  NewtonReport step(double t, double previous_step);

  /// What errors are parts of, each group by itself: the forces of the tools and of pairs of bodies, or,
  /// without either or with pairs of a body with itself only, whose forces cancel out, the norm of the forces
  /// of supports; then, of each tool that a force or a moment drives, which leave its own force no error, how
  /// far that has taken it.
  using Results = std::vector<ErrorControl::Forces>;
  /// At the last accepted step. Their number is that of result_names().
  Results results() const;
  /// "forces", "travel of 'die'": of each group.
  std::vector<std::string> result_names() const;

  /// A step that is tried and not taken.
  struct Probe {
    NewtonReport newton;
    Results results; ///< at its end
  };
  /// Tries the step to `t`, and leaves the state as it is. The next steps up to `t` begin their iterations
  /// from what it found.
  Probe probe(double t, double previous_step);

  /// What penetrations make of the results at the end of a step.
  struct OfPenetration {
    double penetration = 0.;       ///< the deepest, as penetration(), before augmentation
    Results with, without;         ///< or empty: not found
    double residual = 0.;          ///< of `without`, as part of the forces
    unsigned int n_iterations = 0; ///< that it took besides those of the step
  };
  /// The next step measures that, if it is accepted. Where tractions are not augmented in it, anyway, one or
  /// a few iterations more do it, and are taken back. If they make more than this part of a result, that
  /// step already augments tractions until no more than that is left.
  void measure_penetration(const double allowed = std::numeric_limits<double>::infinity()) {
    measures_penetration_ = true;
    allowed_at_measurement_ = allowed;
  }
  /// Of the last accepted step; once.
  std::optional<OfPenetration> take_measurement() { return std::exchange(of_penetration_, {}); }
  /// Of the last accepted step: the deepest, as part of the 'Penetration tolerance', or of 1e-5 facets in
  /// pairs without one.
  double penetration() const { return penetration_; }
  /// Tractions are augmented where penetrations are above so many times what pairs ask for. What augmentation
  /// leaves above that is an error to be told, and fails no step.
  void set_penetration_allowed(const double factor) {
    penetration_allowed_ = factor;
    may_leave_penetration_ = true;
  }
  /// Residuals, and their work, have to be this part of what the solver's tolerances allow; in (0, 1].
  void set_accuracy(const double factor) { accuracy_ = factor; }
  /// Where steps with another contact tangent fail: from here on it is the exact one, of an unsymmetric
  /// matrix. False, and nothing is done, where it is exact already, or nothing can touch. Collective.
  bool take_exact_tangent();

  /// Of the last step that was tried, in dynamic scenes: see ImplicitMotion::step_error().
  double time_error() const { return time_error_; }

  /// Of all bodies, in dynamic scenes.
  double mass() const { return motion_ ? motion_->mass() : 0.; }

  /// Moves the tools to where they are at `t`; residuals and tangents are those of the step that ends there.
  void start_step(double t);

  /// The unknowns, displacements and travels of tools that press with a force, at the start of the step.
  Epetra_Vector unknowns() const;

  const SolutionState &state() const override { return state_; }
  std::vector<ElementSummary> summarize(const std::size_t body) const override {
    return internal_.summarize(body, state_.displacements);
  }
  std::vector<LayerSummaries> summarize_layers(const std::size_t body) const override {
    return internal_.summarize_layers(body, state_.displacements);
  }
  std::vector<std::vector<ContactNodeReport>> report_contacts() const override;
  std::array<std::size_t, 2> history_sizes() const override;
  std::string method() const override { return linear_->name(); }
  DiagnosticList initial_diagnostics() const override;
  /// Messages about stabilised bodies at the end of the run.
  DiagnosticList check_stabilisation() const;
  /// Of static scenes, at the end of the run: whether contact has lost or made energy all in all.
  DiagnosticList check_balance() const;
  /// At the end: what round-off of contact's penalties is beside the largest forces of the run.
  DiagnosticList check_contact_round_off() const;
  /// At the end: pairs whose augmentation was given up while it changed forces.
  DiagnosticList check_augmentation() const;
  /// Of static scenes with bodies that are stabilised, or null.
  const ContactStabilisation *stabilisation() const { return stabilisation_.get(); }
  bool solves_iteratively() const override { return linear_->is_iterative(); }
  const InternalForces &internal_forces() const { return internal_; }
  const std::vector<RigidContact> &contacts() const { return contacts_; }
  const BodyContact &body_contact(const std::size_t pair) const { return *body_contacts_[pair]; }
  const Supports &supports() const { return supports_; }
  /// See PenaltyWatch::has_soft_pairs().
  bool has_soft_penalties() const { return soft_penalties_.has_soft_pairs(); }
  /// Whether contact between bodies makes most of what the energies of a dynamic scene fail to balance by.
  bool contact_makes_energy() const {
    return !body_contacts_.empty() && -contact_balance_ > 0.5 * std::abs(state_.energies.drift());
  }

  /// The state at the end of the last accepted step.
  void save(StateWriter &writer) const;
  /// Goes on from such a state, in place of the start at time 0, or from that of another method: its
  /// displacements and stresses, and, in dynamic scenes, its velocities. Where a static scene has other tools
  /// or pairs, or the state comes from elsewhere, what is out of balance fades over `release_time`, or, if
  /// that is 0, until the end time. In dynamic ones it accelerates the bodies.
  RestartReport load(StateReader &reader, double release_time);

  bool compute_residual(const Epetra_Vector &x, Epetra_Vector &residual) override;
  bool compute_tangent(const Epetra_Vector &x) override;
  bool solve_tangent(const Epetra_Vector &residual, Epetra_Vector &dx, double relative_tolerance) override;
  double max_step_length(const Epetra_Vector &x, const Epetra_Vector &direction) override;
  double force_scale() const override { return force_scale_; }
  double round_off_force() const override {
    return round_off_force_ + (motion_ ? motion_->round_off_force() : 0.);
  }
  double contact_round_off_force() const override { return contact_bears_ ? spring_round_off_ : 0.; }
  StatusChanges status_changes() const override { return status_changes_; }

private:
  /// For the contacts as they are, or, after a restart, as they were when it was built last.
  void build_matrix(bool couplings_are_known = false);
  /// Matrix and solver anew, if contact couples what it did not before.
  void follow_couplings();
  // First guesses of a step, into trial_. The last state, where nothing drives the bodies on; false where
  // something does:
  bool stay_at_rest(double t);
  // the last increment, continued; false where tools or supports change their pace:
  bool continue_increment(double t, double previous_step);
  // what a probe beyond has found, in part:
  bool follow_probe(double t);
  // one linear step from the last state, into which the motion of tools and supports is put; false where it
  // has no solution:
  bool follow_tangent(double t, NewtonIteration &iteration);
  // in dynamic scenes, the motion at constant acceleration; false where it leads farther from balance than to
  // stay:
  bool extrapolate_motion(double t);

  // Of dynamic scenes; at the start, and where forces jump:
  void start_motion();
  void update_accelerations();
  bool is_accurate(double t, NewtonReport &report);
  /// Whether steps may become smaller.
  bool may_be_cut(double t) const;
  /// What the work of the elements' forces in the step, by the trapezoidal rule, misses of their energy.
  struct ElementImbalance {
    double by_yielding; ///< as far as plastic flow explains it [energy]
    double unexplained; ///< [energy]
  };
  ElementImbalance element_imbalance() const;
  /// So far, the step's elements included.
  double largest_energy_of_trial() const;
  /// That as part of what is allowed, (I8).
  double energy_error(double imbalance) const;
  /// Of contact's forces in the residual.
  double contact_weight() const { return motion_ ? motion_->contact_weight() : 1.; }
  /// Of the contact forces at the start of a step in their mean.
  double contact_before() const { return motion_ && motion_->damps_contact() ? 0. : 0.5; }
  /// What contact takes in a step, less what springs then store and friction dissipates; < 0: it makes
  /// energy.
  struct ContactLoss {
    double total = 0.;
    double friction = 0.; ///< of that, by the springs of friction
  };
  /// Of the step at its end. Collective.
  ContactLoss contact_loss(double t) const;
  /// Once damped by (I4) steps stay so until contacts have opened.
  void choose_contact_damping();
  void damp_contact();
  /// Whether nodes go through a tool: then the step fails. Collective.
  bool goes_through_tool(NewtonReport &report) const;
  // Nodes that would go through tools or bodies, in solve/quasi_static_paths.cc.
  /// At the end of the step, with the offsets as they are.
  std::vector<Placement> placements_now() const;
  /// The part of the motion from these displacements (ghosted) and placements to `to`, and the placements of
  /// now, in which no node goes through anything. Says who would, in path_failure_. Collective.
  double find_free_part(const Vector &from, const std::vector<Placement> &tools_from, const Vector &to,
                        bool is_thorough);
  /// Whether nodes go through anything on their ways from the start of the step to the trial state: then the
  /// step fails. Collective.
  bool goes_through(bool is_thorough, NewtonReport &report);
  /// Whether a tool that touches with friction turns by so much from the start of the step to its end that
  /// slip has no direction: then the step fails. Collective.
  bool turns_too_far(double t, NewtonReport &report) const;
  /// Whether a prescribed motion does in the step what its ends do not show: it has to be cut. Collective.
  bool skips_motion(double t, NewtonReport &report) const;
  /// A message about the same where steps cannot be cut. Collective.
  DiagnosticList check_motion(double t) const;
  /// Of each contact, tools first, by how much its penalty should be raised, at the end of the step: 1 is not
  /// at all. Statics only. Collective.
  std::vector<double> raises_of_penalties() const;
  /// Whether one of them is above 1: then the step is to be repeated.
  bool penetrates(NewtonReport &report);
  /// Does that, at the start of the step: the springs that are compressed there are given the energy that
  /// stiffer ones hold, and start the step with their forces.
  void raise_penalties(const std::vector<double> &factors);
  DiagnosticList describe_raises(const std::vector<double> &factors) const;
  /// Of dynamic scenes, after a step, whose contacts are as they were accepted: raises those that are too
  /// low, so that a checkpoint knows them raised. Collective.
  DiagnosticList control_penalties();
  /// Books a change of what the springs of a contact hold [energy].
  void book_in_springs(std::size_t contact, double energy);
  /// Computes all forces at the start of the step.
  void evaluate_start();
  /// What of that is lost for good.
  double taken_by_contact(const ContactLoss &loss) const;
  /// Whether contact makes energy in the step, or takes so much that the step is too long: then it fails.
  bool contact_is_out_of_balance(double t, NewtonReport &report);
  /// Whether nodes close by so much, in the step in which they begin to press, that what happens after the
  /// touch is unknown: then it fails. Of dynamic scenes.
  bool meets_too_early(double t, NewtonReport &report);
  void book_contact(const ContactLoss &loss);
  void update_largest_energy();

  bool assemble_tangent(const TangentSystem &system, double yield_slack = 0.);
  /// The nodes as they stand in the trial state.
  NodalGeometry nodal_geometry() const;
  /// Owned dofs, by local number, of all nodes on which other bodies act, after BodyContact::update().
  std::vector<int> touching_dofs() const;
  NewtonReport attempt_step(double t, double previous_step);
  bool all_ranks(bool success) const;
  void set_trial(const Epetra_Vector &x);
  void commit(double t);

  // Tools whose travel is unknown. The unknown of a tool that turns, and its equation, are scaled by the
  // scene's radius to a length and a force.
  void choose_unknown_tools(const std::vector<std::size_t> &tools);
  Epetra_Vector pack(const Vector &displacements, const std::vector<double> &offsets) const;
  Placement place(std::size_t tool, double t, double offset) const;
  void place_tools(double t);
  double unit_of(std::size_t tool) const;
  /// What the tool exerts along its direction, or about its axis.
  double exerted_load(std::size_t tool) const;
  /// The same less what it should exert: zero in equilibrium.
  double excess_load(std::size_t tool, double t) const;
  /// With the inertia of a heavy tool.
  double imbalance(std::size_t tool, double t) const;
  RigidContact::ToolRate rate_of(std::size_t tool) const;
  void assemble_tool_tangent();
  /// K du + B ds = r_u, C du + D ds = r_s by elimination of du. A tool that touches nothing goes on until it
  /// does. `sense` is 1 where the solution is what is added to the unknowns, −1 where it is what is
  /// subtracted.
  bool solve_with_tools(const Vector &r_u, const std::vector<double> &r_s, double sense,
                        double relative_tolerance, Vector &du, std::vector<double> &ds);
  double distance_to_touch(std::size_t tool) const;
  std::vector<std::size_t> tools_to_stop(double t) const;
  /// The augmented Lagrangian: tractions are augmented and iterated anew until all pairs have what they ask
  /// for. Continues `report`. In solve/quasi_static_augmentation.cc.
  void augment(NewtonReport &report, std::vector<double> &offsets, Vector &displacements);
  /// The tractions of all, once; in measurements, which take it back.
  void augment_contacts();
  /// Of each contact, tools first: by how much it is farther from what its pair asks for than it may be, as
  /// `errors`; or softer than it may be, SoftnessLimit. At the trial state. Collective.
  struct AugmentationDemands {
    std::vector<double> of_contacts;
    double by_tolerances = 0., largest = 0.; ///< of all
  };
  AugmentationDemands augmentation_demands(const std::vector<ContactSprings> &springs) const;
  /// Of each contact, tools first; of none if no pair limits softness. Collective.
  std::vector<ContactSprings> contact_springs() const;
  /// What an augmentation has changed of the forces of each contact. Collective.
  std::vector<std::array<SoftnessLimit::Change, 2>>
  changes_of(const std::vector<ContactSprings> &before, const std::vector<ContactSprings> &after) const;
  /// The tractions of those that are augmented, once.
  void augment_where_asked();
  void take_back_augmentation();
  /// get(contact) of each contact of this rank, tools first.
  template <class Get> auto of_contacts(const Get &get) const {
    std::vector<std::decay_t<decltype(get(contacts_.front()))>> values;
    for (const auto &contact : contacts_)
      values.push_back(get(contact));
    for (const auto &contact : body_contacts_)
      values.push_back(get(*contact));
    return values;
  }
  /// Returns those of each contact of this rank, tools first.
  std::vector<std::vector<SlaveForce>> slave_forces() const;
  /// Compares the contacts with those at the last tangent. Collective.
  StatusChanges find_status_changes() const;
  /// Of each contact, tools first, as part of what its pair asks for. Collective.
  std::vector<double> augmentation_errors() const;
  /// The largest of them. Collective.
  double augmentation_error() const;
  /// That, and the depth in pairs that are not augmented: see penetration(). Collective.
  double find_penetration() const;
  /// Whether any can be other than zero: a body's on itself cannot.
  bool has_forces_of_contacts() const;
  /// Of each contact, tools first: how many times as stiff its penalties may become. Collective.
  std::vector<double> stiffening_left() const;
  /// The penalties of one of these contacts.
  void stiffen(std::size_t contact, double factor);
  /// Makes the penalties of contacts stiffer whose errors, above 1, fell by little since `before`. `added` is
  /// what the last augmentation added to the normal force, as part of what springs held. Collective.
  /// Returns the factors, all 1 if none is.
  std::vector<double> stiffen_slow_contacts(const std::vector<double> &before,
                                            const std::vector<double> &errors,
                                            const std::vector<double> &added);
  /// Makes penalties of augmented contacts that are stiffer than 10 E/h as stiff as that, with a message on
  /// each; false if there is none. Collective.
  bool soften_augmented_contacts(DiagnosticList &messages);
  /// The force that round-off in positions makes of the stiffest penalty. Collective.
  double find_spring_round_off() const;
  /// Whether a step that has converged has to fail, since contact's round-off leaves too much of the forces
  /// in it, as in those before it, or in the last of the run.
  bool is_lost_in_round_off(double t, NewtonReport &report);
  /// What is left of the forces, why and what to do.
  std::string describe_round_off(double part) const;
  /// A message if the step was accepted with this part of the forces, more than the tolerance, since
  /// round-off lets it come no nearer.
  DiagnosticList check_round_off(double part) const;
  /// The warning about a step that was accepted although its iterations stalled.
  Diagnostic describe_stall(const NewtonReport &report) const;
  /// Names of the pairs whose penalties make most of it. Collective.
  std::string stiffest_pairs() const;
  /// Messages about the penalties after a step. In solve/quasi_static_guards.cc.
  DiagnosticList check_penalties();
  /// Of a failed static step: whether round-off of its contacts may be as large as what is left. Collective.
  bool may_be_round_off(const NewtonReport &report) const;
  /// At the end of a step: tools whose load friction bears, and that slip nearly all over. Collective.
  void find_slipping_tools();
  /// Of a failed step: what that may have to do with it.
  std::string describe_slipping_tools() const;
  /// Where the residual of a failed step is largest. Collective.
  std::string describe_residual();
  /// results(), at the trial state.
  Results trial_results() const;
  /// The tools' travel by these offsets, a group each.
  void add_travels(const std::vector<double> &offsets, Results &results) const;
  /// Completes what augmentations in the step have begun to measure, or makes it, from the state `accepted`
  /// of a step that has converged. Adds its iterations.
  void measure_penetration(const Epetra_Vector &accepted, NewtonReport &report);
  /// Whether that was more than is allowed at once; then tractions are to be augmented further.
  bool allow_less_penetration();
  NewtonReport iterate(std::vector<double> &offsets, Vector &displacements);
  // Ways out where Newton's method fails, in solve/quasi_static_continuation.cc.
  /// By how many octaves, factors of 2, the penalties of a contact are stiffer than 10 E/h.
  struct Octaves {
    int normal = 0, tangential = 0;
  };
  /// Of each contact, tools first. Collective.
  std::vector<Octaves> octaves_above_enough() const;
  /// Whether a static step that fails may be led to by softer penalties. Collective.
  bool has_stiff_contacts() const;
  /// As iterate(), with penalties of 10 E/h first, which then grow to what they are.
  NewtonReport iterate_from_softer(std::vector<double> &offsets, Vector &displacements);
  /// That a step needed that. Collective.
  Diagnostic needs_softer_penalties() const;
  double fading(double t, std::size_t tool) const;
  void remove_tools(double t);
  /// A rigid motion of the body that supports and contacts do not hold, if there is one. On all ranks.
  std::optional<RigidMotion> find_freedom(std::size_t body) const;
  /// A message if those that are left do not hold a body, else empty. Tools of these names were `removed`.
  std::string describe_freedom(std::size_t body, const std::set<std::string> &removed) const;
  /// Bodies that others may hold have to be held, or to touch them, at the start.
  void check_freedom() const;
  // Whether the state of a static step that has converged may be the next one, in
  // solve/quasi_static_support.cc. All collective.
  void prepare_support_check();
  /// What holds the bodies beside contact, at the trial state.
  RigidBodySupport hold_bodies() const;
  /// The same with contact.
  RigidBodySupport::Result find_support(const std::vector<bool> &unloaded_bodies = {}) const;
  template <class AddContact> void add_supporting_points(const AddContact &add) const;
  void add_supports(RigidBodySupport &support) const;
  // Bodies that viscous forces hold, in solve/quasi_static_stabilisation.cc.
  /// After prepare_support_check(). Collective.
  void prepare_stabilisation();
  bool is_stabilised(const std::size_t body) const {
    return stabilisation_ != nullptr && stabilisation_->acts_on(body);
  }
  /// The residual of an unloaded body is small beside the forces of its steady motion, too.
  void add_stabilisation(Vector &residual);
  void add_stabilisation_tangent(const TangentSystem &system) const;
  void commit_stabilisation();
  void save_stabilisation(StateWriter &writer) const;
  void load_stabilisation(StateReader &reader);
  /// What supports and contact resist at the trial state, contact of stabilised bodies in one sense only.
  RigidBodySupport::Result find_support_by_contact() const;
  /// Σ |f| of the nodes of contacts, by body [force]. Collective.
  std::vector<double> contact_forces_on_bodies() const;
  /// A body that is free to move so is held by viscous forces from now on if contact bore next to nothing at
  /// the end of the last step. Returns whether it is.
  bool hold_if_let_go(const RigidBodySupport::Mode &mode);
  /// The same with bodies that others touch without a force, at the end of this step. Collective.
  void hold_unloaded_bodies();
  /// Whether a body loses its support, or bodies are thrown out of the scene: then the step fails.
  bool loses_bodies(double t, NewtonReport &report);
  bool moves_too_far(double t, NewtonReport &report) const;
  /// Of a failed step: bodies that slid on all that they touched at the end of the last one.
  std::string describe_sliding() const;
  /// A mode that only points resist which slip, or nearly do. Collective.
  std::optional<RigidBodySupport::Mode> find_sliding_soon() const;
  /// Of all pairs in the step, before commit(). Collective.
  StepWorks compute_step_works() const;
  /// Whether contact makes or loses so much energy that a static step has to be cut.
  bool loses_energy(double t, NewtonReport &report);
  // Of load(), in solve/quasi_static_state.cc:
  void load_tools(StateReader &reader);
  void load_contacts(StateReader &reader);
  /// What touches what now, and a matrix for it.
  void update_contacts(StateReader &reader, bool is_exact);
  /// All forces at the state as it is: those of supports and tools, and what is out of balance.
  void balance(RestartReport &report);
  void load_motion(StateReader &reader, RestartReport &report);
  /// Part of the imbalance that is left at t.
  double imbalance_left(double t) const;

  const Scene &scene_;
  const Discretization &discretization_;
  Supports supports_;
  MotionWatch motions_;
  InternalForces internal_;
  std::vector<RigidContact> contacts_;
  std::unique_ptr<LocalNodes> nodes_; ///< only with contact between bodies
  std::vector<std::unique_ptr<BodyContact>> body_contacts_;
  std::unique_ptr<ImplicitMotion> motion_; ///< none in statics

  ContactTangent tangent_;
  Matrix matrix_;
  NodalGeometry undeformed_; ///< where the linear solver is iterative
  std::unique_ptr<TangentSolver> linear_;

  Vector trial_, trial_ghosted_, u_n_, last_increment_;
  Vector raw_internal_, raw_contact_;        ///< additive
  Vector support_forces_, support_forces_n_; ///< residual before constraints: what the supports exert
  Vector contact_forces_, contact_forces_n_; ///< −F_c
  Vector internal_forces_, internal_forces_n_;
  Vector bare_forces_n_; ///< what the integrator takes for F_n: support_forces_n_, or without contact
  // What contact has taken and not yet given back, of static scenes in all steps that are no jumps; what is
  // lost of it in dynamic scenes; the largest energy so far.
  double contact_balance_ = 0., trial_contact_loss_ = 0.;
  ContactLosses contact_losses_;
  RoundOffWatch round_off_;
  double largest_energy_ = 0.;
  double force_scale_ = 0., lasting_scale_ = 0., round_off_force_ = 0., spring_round_off_ = 0.;
  bool contact_bears_ = false;                      ///< at the last residual
  std::vector<std::vector<SlaveForce>> linearised_; ///< slave_forces() at the last tangent
  StatusChanges status_changes_;                    ///< between that and the last residual
  bool accepts_stalled_ = false;                    ///< in the attempt that is made
  unsigned int n_in_round_off_ = 0;                 ///< of the last accepted steps, those that are lost in it

  double time_ = 0.;     ///< end of the step that is tried
  double duration_ = 0.; ///< of that step; 0 while its first guess is made
  double time_error_ = 0.;
  InternalForces::Energies trial_energies_;
  // Of dynamic scenes: what the work of the elements' forces misses of their energy, in the step and so far.
  double trial_imbalance_ = 0., element_balance_ = 0.;
  std::vector<double> offsets_, offsets_n_; ///< of all tools, beyond their prescribed motion
  std::vector<double> last_offset_increments_;
  struct ProbedState {
    double time;
    Vector displacements;
    std::vector<double> offsets;
  };
  std::unique_ptr<ProbedState> probe_; ///< of the last probe, while steps may start from it
  bool is_probing_ = false;
  bool is_led_by_softer_ = false; ///< of the step that is tried
  double penetration_allowed_ = 1., accuracy_ = 1.;
  double penetration_ = 0.;
  bool measures_penetration_ = false, may_leave_penetration_ = false;
  double allowed_at_measurement_ = 0.; ///< part of the forces
  std::optional<OfPenetration> of_penetration_;
  PenaltyControl penalties_; ///< of dynamic scenes
  PenaltyWatch soft_penalties_;
  SoftnessLimit softness_{{}};
  std::vector<double>
      tool_pair_energies_;     ///< in the springs of each pair with a tool, at the last step's end
  bool has_lost_pace_ = false; ///< a tool stopped or went at the end of the last step
  std::string tool_failure_;
  std::string path_failure_;   ///< which nodes would go through what
  std::vector<double> raises_; ///< what a step that penetrates asks for
  std::string body_failure_;   ///< why there is no next step: tools were removed that a body needs
  std::vector<std::size_t> slipping_tools_;         ///< at the end of the last accepted step
  std::vector<std::size_t> unknown_tools_;          ///< those whose offset is unknown in this step
  std::unique_ptr<Epetra_Map> map_;                 ///< of displacements and unknown offsets
  std::vector<std::unique_ptr<Placement>> stopped_; ///< where tools have stopped for good
  std::vector<Vector> tool_columns_, tool_rows_;    ///< B, condensed; C
  dealii::FullMatrix<double> tool_block_;           ///< D
  HeldMemory tool_memory_{Capability::driven_tools};
  std::vector<std::unique_ptr<Vector>> fading_forces_; ///< residual of a removed tool's forces, as they were
  std::unique_ptr<Vector> imbalance_; ///< residual at a restart, on dofs that are free; or none
  double imbalance_begin_ = 0., imbalance_end_ = 0.; ///< when it begins to fade, and has gone
  /// Of static scenes, none if supports alone hold all bodies.
  std::vector<RigidBodySupport::Body> body_frames_;
  struct SupportedNode {
    std::size_t body;
    dealii::Tensor<1, 3> position, normal; ///< undeformed
    std::array<DofIndex, 3> dofs;
  };
  std::vector<SupportedNode> supported_nodes_;
  /// contact_forces_on_bodies() at the end of the last step, and the largest so far.
  std::vector<double> body_forces_n_, largest_forces_;
  struct Loss {
    double time = -1.;
    std::string text;
  };
  Loss loss_; ///< the earliest of a body that a step failed for; explains what steps before it fail for
  std::vector<RigidBodySupport::Mode> let_go_;          ///< bodies that this step has begun to hold
  std::unique_ptr<ContactStabilisation> stabilisation_; ///< of static scenes with such bodies
  std::vector<bool> needs_no_stabilisation_;            ///< of bodies that supports hold; or empty
  RigidBodySupport::Result support_by_contact_;         ///< of the last step, while bodies are stabilised
  StepEnergy step_energy_;
  RigidBodySupport::Result support_; ///< at the end of the last accepted step
  SolutionState state_;
};

} // namespace billet

#endif
