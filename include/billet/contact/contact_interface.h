// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CONTACT_INTERFACE_H
#define BILLET_CONTACT_CONTACT_INTERFACE_H

#include "billet/contact/contact_checks.h"
#include "billet/contact/contact_couplings.h"
#include "billet/contact/contact_measures.h"
#include "billet/contact/contact_penalties.h"
#include "billet/discretization/local_nodes.h"
#include "billet/discretization/node_keys.h"
#include "billet/discretization/supports.h"
#include "billet/geometry/placement.h"
#include "billet/scene/scene.h"
#include "billet/state.h"

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
/// commit(). This class advances the pair and adds its forces; penalties(), measures(), couplings() and
/// checks() have the rest, of the last update() like the forces. Virtual functions are called once per pair,
/// never per node.
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

  // Roles.

  virtual ContactPenalties &penalties() = 0;
  virtual const ContactPenalties &penalties() const = 0;
  virtual const ContactMeasures &measures() const = 0;
  /// Returns no couplings, unless contact is between bodies.
  virtual ContactCouplings &couplings() { return no_couplings_; }
  virtual const ContactCouplings &couplings() const { return no_couplings_; }
  virtual const ContactChecks &checks() const = 0;

  // Steps.

  virtual void start_step(const ContactStep &step) = 0;
  /// Sets how FrictionRule accounts for friction: ½ and false unless they are set.
  virtual void set_friction_account(double start_weight, bool is_static) = 0;
  /// Returns to the start of the step.
  virtual void restart() = 0;
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
  /// Returns the part of a motion during which no node goes through a surface (C12). A node that would soon
  /// come out on another side counts as through. Collective.
  virtual double find_free_part(const ContactPath &path) const = 0;

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

private:
  const PairSettings &settings_;
  std::vector<std::size_t> bodies_;
  std::optional<std::size_t> rigid_tool_;
  std::string partners_;
  std::string group_kind_;
  std::size_t group_index_;
  ContactCouplings no_couplings_;
};

} // namespace billet

#endif
