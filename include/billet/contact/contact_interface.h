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

/// The step in which a contact pair computes forces.
struct ContactStep {
  double start, end; ///< [time]
  double duration;   ///< end − start, with the bits of the scheme [time]
  const std::vector<Placement> &tools_at_start, &tools_at_end; ///< of all tools of the scene
};

/// A motion of bodies and tools along straight paths.
struct ContactPath {
  const Vector &from, &to; ///< displacements (ghosted)
  const std::vector<Placement> &tools_from, &tools_to;
  bool is_thorough; ///< also checks motions that are small compared with facets
};

/// A contact pair: a body and a rigid tool, two bodies, or a body with itself.
///
/// A step calls start_step(), then update() at any displacements and queries about the last update(), then
/// commit(). Forces, penetrations and reports are those of the last update(). Virtual functions are called
/// once per pair, never per node.
///
/// Functions are local to this rank unless documented otherwise.
class ContactInterface {
public:
  virtual ~ContactInterface() = default;
  ContactInterface(const ContactInterface &) = delete;
  ContactInterface &operator=(const ContactInterface &) = delete;

  const PairSettings &settings() const { return settings_; }
  const std::string &name() const { return settings_.name; }
  /// Returns one body, or two, which may be the same.
  const std::vector<std::size_t> &bodies() const { return bodies_; }
  /// Returns the index in Scene::tools(); none for contact between bodies.
  const std::optional<std::size_t> &rigid_tool() const { return rigid_tool_; }
  /// Names the two partners, for checkpoints and messages.
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
  /// Returns the works that the trapezoidal rule miscounts, before commit(). `weight` is that of the forces
  /// at the end of the step in the mean forces. Collective.
  virtual StepWorks compute_step_works(double weight) const = 0;
  /// Returns the part of a motion during which no node goes through a surface (C12). A node that would soon
  /// come out on another side counts as through. Collective.
  virtual double find_free_part(const ContactPath &path) const = 0;
  /// Whether a node has passed through a tool from side to side in the step (T9). This is possible only if
  /// `may_let_nodes_through()`, which is the same on all ranks.
  virtual bool may_let_nodes_through() const { return false; }
  virtual bool lets_nodes_through() const { return false; }
  /// Names the failure of a step in which nodes have gone through.
  virtual std::string describe_passage() const { return ""; }

  // Couplings between bodies, which the matrix contains in addition to those of elements; none with a rigid
  // tool.

  /// Whether add_tangent() has entries of this rank that the last add_couplings() did not include.
  virtual bool has_new_couplings() const { return false; }
  /// Finds the nodes that add_tangent() may couple, after update(). Collective.
  virtual void find_couplings() {}
  /// Adds the dofs whose rows add_tangent() writes to.
  virtual void add_foreign_dofs(dealii::IndexSet & /*dofs*/) const {}
  /// Adds the entries that add_tangent() writes.
  virtual void add_couplings(SparsityPattern & /*pattern*/) const {}
  /// Saves the result of the last find_couplings(): another matrix pattern would change the bits of a run.
  virtual void save_couplings(StateWriter & /*writer*/) const {}
  /// Loads a saved result in place of find_couplings(). Returns false, on all ranks, if other ranks saved it
  /// or it belongs to another tangent.
  virtual bool load_couplings(const StateReader & /*reader*/) { return true; }

  // Schemes without a matrix.

  /// Computes gaps and tractions. Collective.
  virtual void update(const NodalVectors &displacements) = 0;
  /// Adds F_c [force], and to component 0 of `bounds` a bound of the stiffness at a node [force/length].
  /// Returns the load of this rank's facets; for two bodies, only its dissipation.
  virtual ContactLoad add_forces(NodalVectors &forces, NodalVectors &bounds) = 0;
  /// Adds nodes that cross surfaces, before commit().
  virtual void add_crossings(Crossings &crossings) const = 0;
  /// Adds the crossings of the first step at these velocities of nodes. Tools count as at rest; contact
  /// between bodies adds none.
  virtual void add_start_crossings(Crossings & /*crossings*/, const NodalVectors & /*velocities*/,
                                   double /*step*/) const {}
  /// Returns Σ a·k a of the penalties against a tool that translates along its force's direction, or rotates
  /// about its axis [force/length, or force length]. a is the change of a node's gap and slip for a unit of
  /// that motion. Returns 0 without such a tool.
  virtual double stiffness_against_tool() const { return 0.; }

  // Penalties and the augmented Lagrangian.

  /// Returns to the start of the step.
  virtual void restart() = 0;
  /// Transfers the tractions of the last update() from the springs to the multipliers.
  virtual void augment() = 0;
  /// Undoes the augmentations since the last restart() or commit().
  virtual void take_back_augmentation() = 0;
  /// Returns the maximum error that augmentation can reduce, relative to the pair's tolerance; 0 without a
  /// tolerance.
  double augmentation_error() const {
    const double tolerance = settings_.penetration_tolerance.value_or(0.);
    return tolerance > 0. ? augmentation_gap() / tolerance : 0.;
  }
  virtual ContactSprings compute_springs() const = 0;
  /// Multiplies penalties; the multipliers stay unchanged. After augment().
  virtual void scale_penalties(double normal, double tangential) = 0;
  void stiffen(const double factor) { scale_penalties(factor, factor); }
  /// Multiplies penalties and keeps tractions: the excess penetration is allowed from now on. After update()
  /// without augmentation.
  virtual void stiffen_under_load(double normal, double tangential) = 0;
  /// Returns the factors on the given penalties so far.
  virtual double stiffening() const = 0;
  virtual double tangential_stiffening() const = 0;
  /// Returns the factor at which the first of this rank's penalties reaches 10 E/h; it is below 1 if one
  /// exceeds that.
  double stiffening_left() const { return max_stiffening_ / stiffening(); }
  /// Returns the same factor for tangential penalties; infinite without friction.
  double tangential_stiffening_left() const { return max_tangential_stiffening_ / tangential_stiffening(); }
  /// Returns the maximum of penalty times facet size squared [force/length].
  virtual double largest_spring() const = 0;
  /// Returns the largest length, apart from positions, that enters gaps: the radius of a tool's curvature, at
  /// most its size [length].
  virtual double surface_reach() const { return 0.; }

  // Measures.

  virtual Penetration penetration() const = 0;
  /// Returns the penetration relative to the acceptable one.
  virtual double excessive_penetration() const = 0;
  /// Returns the maximum closing in the step of a node that presses at its end but not at its start [facet
  /// sizes].
  virtual double closing_of_new_contacts() const = 0;
  /// Returns the load on the first body. Collective.
  virtual ContactLoad compute_load() const = 0;
  /// Returns the status and the force of each slave node.
  virtual std::vector<SlaveForce> slave_forces() const = 0;
  virtual std::vector<ContactNodeReport> report() const = 0;
  /// Returns the number of doubles of history.
  virtual std::size_t history_size() const = 0;
  /// Adds the resistances that constrain this body where a tool or another body touches it.
  virtual void add_resistances(std::size_t body, std::vector<Resistance> &resistances) const = 0;
  /// Visitor that receives the body of the point and the body that it touches; for a tool, the same body
  /// twice.
  using VisitSupporting = std::function<void(const SupportingPoint &, std::size_t body, std::size_t other)>;
  /// Visits the points in contact; none for self-contact.
  virtual void visit_supporting(const VisitSupporting &visit) const = 0;

  // Messages. Collective.

  /// Returns the diagnostics before the first step.
  virtual DiagnosticList check_start() const { return {}; }
  /// Returns the diagnostics after a step.
  virtual DiagnosticList check_step() const { return {}; }
  /// Returns a clause about chattering nodes, which keep changing facet or status; empty if there are none.
  virtual std::string describe_restless() const { return ""; }
  /// Returns a clause about the obstacle that find_free_part() found.
  virtual std::string describe_obstacle() const = 0;

  // The state at the start of the step.

  /// Returns the word under which checkpoints store the pair; group_index() is its number.
  const std::string &group_kind() const { return group_kind_; }
  std::size_t group_index() const { return group_index_; }
  virtual void save(StateWriter &writer, const NodeKeys &keys) const = 0;
  virtual void load(const StateReader &reader, const NodeKeys &keys) = 0;
  /// Starts, in place of load(), a pair that is new at the start of a step, as if it had existed without
  /// contact. Collective.
  virtual void begin(const ContactStep &step, const Vector &displacements) = 0;
  virtual void begin(const ContactStep &step, const NodalVectors &displacements) = 0;

protected:
  ContactInterface(const Scene &scene, const ContactPair &pair);
  ContactInterface(const Scene &scene, const BodyPair &pair);

  /// Returns the maximum gap of a node that presses, and elastic slip of one that sticks [facet sizes].
  virtual double augmentation_gap() const = 0;

  /// The factors at which the first of this rank's given penalties reaches 10 E/h.
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
