// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CONTACT_INTERFACE_H
#define BILLET_CONTACT_CONTACT_INTERFACE_H

#include "billet/contact/contact_checks.h"
#include "billet/contact/contact_measures.h"
#include "billet/contact/contact_penalties.h"
#include "billet/contact/contact_step.h"
#include "billet/contact/explicit_contact.h"
#include "billet/contact/matrix_contact.h"
#include "billet/discretization/node_keys.h"
#include "billet/scene/scene.h"
#include "billet/state.h"

#include <optional>
#include <string>
#include <vector>

namespace billet {

struct FrictionAccounting;

/// A contact pair: a body and a rigid tool, two bodies, or a body with itself.
///
/// A step calls start_step(), then update() at any displacements and queries about the last
/// update(), then commit(). This class advances the pair, and its roles have the rest. A pair has
/// one of the forces of a scheme, with_matrix() or without_matrix(). It also has penalties(),
/// measures() and checks(), which like the forces are those of the last update(). Virtual functions
/// are called once per pair, never per node.
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

  /// Returns the forces and tangents in schemes with a matrix, which the pair is made for.
  virtual MatrixContact &with_matrix() = 0;
  virtual const MatrixContact &with_matrix() const = 0;
  /// Returns the forces and bounds in schemes without a matrix, which the pair is made for.
  virtual ExplicitContact &without_matrix() = 0;
  virtual const ExplicitContact &without_matrix() const = 0;
  virtual ContactPenalties &penalties() = 0;
  virtual const ContactPenalties &penalties() const = 0;
  virtual const ContactMeasures &measures() const = 0;
  virtual const ContactChecks &checks() const = 0;

  // Steps.

  virtual void start_step(const ContactStep &step) = 0;
  /// Sets how works of friction are counted: with ½, and those of a motion, by default.
  virtual void set_friction_account(double start_weight, const FrictionAccounting &accounting) = 0;
  /// Returns to the start of the step.
  virtual void restart() = 0;
  /// The state of the last update() becomes the start of the next step.
  virtual void commit() = 0;

  // The state at the start of the step.

  /// Returns the word under which checkpoints store the pair; group_index() is its number.
  const std::string &group_kind() const { return group_kind_; }
  std::size_t group_index() const { return group_index_; }
  virtual void save(StateWriter &writer, const NodeKeys &keys) const = 0;
  virtual void load(const StateReader &reader, const NodeKeys &keys) = 0;
  /// After load(): sets how gaps of a coarser mesh fade. New nodes of a finer mesh lie on chords of
  /// its faces, inside a curved tool. They keep the gaps that the coarser mesh had, and come out of
  /// the tool from `begin` to `end` [time]. Pairs of bodies, and implicit dynamics, have the gaps
  /// of the finer mesh at once. `is_finer`: whether the mesh is finer than the one that load()
  /// reads, after begin().
  virtual void fade_gaps(const double /*begin*/, const double /*end*/, const bool /*is_finer*/) {}

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
};

} // namespace billet

#endif
