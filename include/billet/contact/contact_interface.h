// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CONTACT_INTERFACE_H
#define BILLET_CONTACT_CONTACT_INTERFACE_H

#include "billet/contact/contact_load.h"
#include "billet/contact/status_changes.h"
#include "billet/contact/step_works.h"
#include "billet/contact/supporting_point.h"
#include "billet/diagnostics.h"
#include "billet/discretization/local_nodes.h"
#include "billet/discretization/node_keys.h"
#include "billet/discretization/supports.h"
#include "billet/geometry/placement.h"
#include "billet/scene/rigid_motions.h"
#include "billet/scene/scene.h"
#include "billet/state.h"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace billet {

/// The step whose forces a contact pair computes.
struct ContactStep {
  double start, end; ///< [time]
  double duration;   ///< end − start, as the scheme has it to the last bit [time]
  const std::vector<Placement> &tools_at_start, &tools_at_end; ///< of all tools of the scene
};

/// A motion of bodies and tools on straight ways.
struct ContactPath {
  const Vector &from, &to; ///< displacements (ghosted)
  const std::vector<Placement> &tools_from, &tools_to;
  bool is_thorough; ///< motions that are small against facets count, too
};

/// A contact pair: of a body with a rigid tool, of two bodies, or of a body with itself.
///
/// A step: start_step(), then update() at any displacements and what is asked about the last update(), then
/// commit(). Forces, penetrations and reports are those of the last update(). Virtual calls are made once per
/// pair, never per node.
///
/// Unless it says otherwise a function is local to this rank.
class ContactInterface {
public:
  virtual ~ContactInterface() = default;
  ContactInterface(const ContactInterface &) = delete;
  ContactInterface &operator=(const ContactInterface &) = delete;

  const PairSettings &settings() const { return settings_; }
  const std::string &name() const { return settings_.name; }
  /// One, or two, which may be the same.
  const std::vector<std::size_t> &bodies() const { return bodies_; }
  /// Of Scene::tools(); none where bodies touch bodies.
  const std::optional<std::size_t> &rigid_tool() const { return rigid_tool_; }
  /// Whom the pair joins, for checkpoints and messages.
  const std::string &partners() const { return partners_; }

  // Steps.

  virtual void start_step(const ContactStep &step) = 0;
  /// Sets how FrictionRule accounts for friction: ½ and false unless they are set.
  virtual void set_friction_account(double start_weight, bool is_static) = 0;
  /// The state of the last update() becomes the start of the next step.
  virtual void commit() = 0;

  // Schemes with a matrix.

  /// Computes gaps and tractions at `displacements` (ghosted). Collective.
  virtual void update(const Vector &displacements) = 0;
  /// Adds −F_c [force] to `residual` (additive vector).
  virtual void add_forces(Vector &residual) const = 0;
  /// Sets the kind of tangents from now on.
  virtual void set_tangent(ContactTangent tangent) = 0;
  /// Adds −∂F_c/∂u [force/length]. Collective.
  virtual void add_tangent(const TangentSystem &system) const = 0;
  /// Returns the works that the trapezoidal rule counts falsely, before commit(). `weight` is that of the
  /// forces at the end of the step in the mean forces. Collective.
  virtual StepWorks compute_step_works(double weight) const = 0;
  /// Returns the part of a motion that takes no node through a surface, or so deep into it that it would soon
  /// come out on another side (C12). Collective.
  virtual double find_free_part(const ContactPath &path) const = 0;
  /// Whether a node has gone through a tool, from side to side, in the step, (T9), where
  /// `may_let_nodes_through()`, alike on all ranks.
  virtual bool may_let_nodes_through() const { return false; }
  virtual bool lets_nodes_through() const { return false; }
  /// Names the failure of a step in which nodes have gone through.
  virtual std::string describe_passage() const { return ""; }

  // Couplings between bodies, which the matrix has to hold beside those of elements; none with a rigid tool.

  /// Whether add_tangent() has entries of this rank that the last add_couplings() did not name.
  virtual bool has_new_couplings() const { return false; }
  /// Finds which nodes add_tangent() may couple, after update(). Collective.
  virtual void find_couplings() {}
  /// Adds the dofs whose rows add_tangent() writes to.
  virtual void add_foreign_dofs(dealii::IndexSet & /*dofs*/) const {}
  /// Adds the entries that add_tangent() writes.
  virtual void add_couplings(SparsityPattern & /*pattern*/) const {}
  /// Saves what the last find_couplings() found: another matrix pattern would change the bits of a run.
  virtual void save_couplings(StateWriter & /*writer*/) const {}
  /// Loads that in place of find_couplings(). False, on all ranks, if it was saved by other ranks or for
  /// another tangent.
  virtual bool load_couplings(const StateReader & /*reader*/) { return true; }

  // Schemes without a matrix.

  /// Computes gaps and tractions. Collective.
  virtual void update(const NodalVectors &displacements) = 0;
  /// Adds F_c [force], and to component 0 of `bounds` what bounds the stiffness at a node [force/length].
  /// Returns the load of this rank's facets, of two bodies its dissipation alone.
  virtual ContactLoad add_forces(NodalVectors &forces, NodalVectors &bounds) = 0;
  /// Adds nodes that come through surfaces, before commit().
  virtual void add_crossings(Crossings &crossings) const = 0;
  /// Adds those of the first step, at these velocities; only tools that rest are known to.
  virtual void add_start_crossings(Crossings & /*crossings*/, const NodalVectors & /*velocities*/,
                                   double /*step*/) const {}
  /// Returns Σ a·k a of the penalties against a tool that moves along its force's direction, or turns about
  /// its axis [force/length, or force length]: a is what a node's gap and slip are to a unit of that motion.
  /// 0 without such a tool.
  virtual double stiffness_against_tool() const { return 0.; }

  // Penalties and the augmented Lagrangian.

  /// Back to the start of the step.
  virtual void restart() = 0;
  /// Takes the tractions of the last update() over from the springs.
  virtual void augment() = 0;
  /// Takes back the augmentations since the last restart() or commit().
  virtual void take_back_augmentation() = 0;
  /// The largest error that augmentation can lessen, relative to the pair's tolerance; 0 without one.
  double augmentation_error() const {
    const double tolerance = settings_.penetration_tolerance.value_or(0.);
    return tolerance > 0. ? augmentation_gap() / tolerance : 0.;
  }
  virtual ContactSprings compute_springs() const = 0;
  /// Multiplies penalties; what augmentation holds stays. After augment().
  virtual void scale_penalties(double normal, double tangential) = 0;
  void stiffen(const double factor) { scale_penalties(factor, factor); }
  /// Multiplies penalties and leaves tractions as they are: what of the penetrations would press more is
  /// allowed from now on. After update() without augmentation.
  virtual void stiffen_under_load(double normal, double tangential) = 0;
  /// Returns the factors on the given penalties so far.
  virtual double stiffening() const = 0;
  virtual double tangential_stiffening() const = 0;
  /// Returns the factor after which the first of this rank's penalties is 10 E/h; below 1 where one exceeds
  /// that.
  double stiffening_left() const { return max_stiffening_ / stiffening(); }
  /// The same of tangential penalties; infinite without friction.
  double tangential_stiffening_left() const { return max_tangential_stiffening_ / tangential_stiffening(); }
  /// Returns the largest penalty times the facets' size squared [force/length].
  virtual double largest_spring() const = 0;
  /// Returns how far numbers beyond positions go into gaps: the radius of a tool's curvature, at most its
  /// size [length].
  virtual double surface_reach() const { return 0.; }

  // Measures.

  virtual Penetration penetration() const = 0;
  /// The same as part of what is little enough.
  virtual double excessive_penetration() const = 0;
  /// Returns the most by which a node closes in the step that presses at its end and did not at its start, as
  /// part of the size of its facets.
  virtual double closing_of_new_contacts() const = 0;
  /// On the first body. Collective.
  virtual ContactLoad compute_load() const = 0;
  /// Returns the status of each slave node and its force.
  virtual std::vector<SlaveForce> slave_forces() const = 0;
  virtual std::vector<ContactNodeReport> report() const = 0;
  /// Doubles of history.
  virtual std::size_t history_size() const = 0;
  /// Adds what holds this body where it is touched by a tool or another body.
  virtual void add_resistances(std::size_t body, std::vector<Resistance> &resistances) const = 0;
  /// Called with the body of the point, and the body that it touches, the same one where that is a tool.
  using VisitSupporting = std::function<void(const SupportingPoint &, std::size_t body, std::size_t other)>;
  /// Visits what touches; nothing of a body that touches itself.
  virtual void visit_supporting(const VisitSupporting &visit) const = 0;

  // Messages. Collective.

  /// What a user should know before the first step.
  virtual DiagnosticList check_start() const { return {}; }
  /// ... and after any.
  virtual DiagnosticList check_step() const { return {}; }
  /// A clause about nodes that keep changing facet or status; empty if there are none.
  virtual std::string describe_restless() const { return ""; }
  /// A clause about what find_free_part() found.
  virtual std::string describe_obstacle() const = 0;

  // The state at the start of the step.

  /// The word and the number under which checkpoints keep the pair.
  const std::string &group_kind() const { return group_kind_; }
  std::size_t group_index() const { return group_index_; }
  virtual void save(StateWriter &writer, const NodeKeys &keys) const = 0;
  virtual void load(const StateReader &reader, const NodeKeys &keys) = 0;
  /// Starts in place of load() a pair that is new at the start of a step, as if it had been there without
  /// contact. Collective.
  virtual void begin(const ContactStep &step, const Vector &displacements) = 0;
  virtual void begin(const ContactStep &step, const NodalVectors &displacements) = 0;

protected:
  ContactInterface(const Scene &scene, const ContactPair &pair);
  ContactInterface(const Scene &scene, const BodyPair &pair);

  /// The largest gap of a node that presses, and elastic slip of one that sticks [facet sizes].
  virtual double augmentation_gap() const = 0;

  /// Until the first of this rank's penalties as given is 10 E/h.
  double max_stiffening_ = std::numeric_limits<double>::infinity(),
         max_tangential_stiffening_ = std::numeric_limits<double>::infinity();

private:
  const PairSettings &settings_;
  std::vector<std::size_t> bodies_;
  std::optional<std::size_t> rigid_tool_;
  std::string partners_;
  std::string group_kind_;
  std::size_t group_index_;
};

} // namespace billet

#endif
