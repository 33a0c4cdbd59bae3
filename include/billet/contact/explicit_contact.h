// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_EXPLICIT_CONTACT_H
#define BILLET_CONTACT_EXPLICIT_CONTACT_H

#include "billet/contact/contact_load.h"
#include "billet/contact/contact_step.h"
#include "billet/discretization/local_nodes.h"

namespace billet {

/// Forces of a contact pair in schemes without a matrix, and what they add to the bounds of steps.
/// Displacements are arrays of this rank's nodes.
class ExplicitContact {
public:
  virtual ~ExplicitContact() = default;
  ExplicitContact(const ExplicitContact &) = delete;
  ExplicitContact &operator=(const ExplicitContact &) = delete;

  /// Computes gaps and tractions. Collective.
  virtual void update(const NodalVectors &displacements) = 0;
  /// Adds F_c [force], and to component 0 of `bounds` a bound of the stiffness at a node
  /// [force/length]. Returns the load of this rank's facets; for two bodies, only its dissipation.
  virtual ContactLoad add_forces(NodalVectors &forces, NodalVectors &bounds) = 0;
  /// Adds nodes that cross surfaces, before ContactInterface::commit().
  virtual void add_crossings(Crossings &crossings) const = 0;
  /// Adds the crossings of the first step at these velocities of nodes. Tools count as at rest;
  /// contact between bodies adds none.
  virtual void add_start_crossings(Crossings & /*crossings*/, const NodalVectors & /*velocities*/,
                                   double /*step*/) const {}
  /// Returns Σ a·k a of the penalties against a tool [force/length, or force length]. The tool
  /// translates along its force's direction, or rotates about its axis. Here a is the change of a
  /// node's gap and slip for a unit of that motion. Returns 0 without such a tool.
  virtual double stiffness_against_tool() const { return 0.; }
  /// Starts a pair that is new at the start of a step, as if it had existed without contact.
  /// Collective.
  virtual void begin(const ContactStep &step, const NodalVectors &displacements) = 0;

protected:
  ExplicitContact() = default;
};

} // namespace billet

#endif
