// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CONTACT_CHECKS_H
#define BILLET_CONTACT_CONTACT_CHECKS_H

#include "billet/diagnostics.h"

#include <string>

namespace billet {

/// Checks of a contact pair, and the messages about what they find. Collective unless documented
/// otherwise.
class ContactChecks {
public:
  virtual ~ContactChecks() = default;
  ContactChecks(const ContactChecks &) = delete;
  ContactChecks &operator=(const ContactChecks &) = delete;

  /// Returns the diagnostics before the first step.
  virtual DiagnosticList check_start() const { return {}; }
  /// Returns the diagnostics after a step.
  virtual DiagnosticList check_step() const { return {}; }

  /// Whether nodes can pass through a tool from side to side in a step (T9); the same on all ranks.
  virtual bool may_let_nodes_through() const { return false; }
  /// Whether a node of this rank has done so, after update() and before commit(). Not collective.
  virtual bool lets_nodes_through() const { return false; }
  /// Explains the failure of a step in which nodes have gone through.
  virtual Explanation describe_passage() const { return {}; }

  /// Returns a clause about chattering nodes, which keep changing facet or status; empty if there
  /// are none.
  virtual Explanation describe_restless() const { return {}; }
  /// Returns a clause about the obstacle that MatrixContact::find_free_part() found.
  virtual std::string describe_obstacle() const = 0;

protected:
  ContactChecks() = default;
};

} // namespace billet

#endif
