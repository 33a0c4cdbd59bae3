// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_STATUS_CHANGES_H
#define BILLET_CONTACT_STATUS_CHANGES_H

#include "billet/contact/traction.h"

#include <deal.II/base/tensor.h>

#include <vector>

namespace billet {

/// The status of a slave node, and the contact force on it from the facets of this rank.
struct SlaveForce {
  ContactStatus status = ContactStatus::open;
  dealii::Tensor<1, 3> force; ///< [force]
};

/// Changes of contact status between two states, and the related changes of forces.
struct StatusChanges {
  /// Slave nodes whose status changed; a shared node counts on each of its ranks.
  double n = 0.;
  double force = 0.;         ///< Σ |Δf| of these nodes [force]
  double contact_force = 0.; ///< Σ |f| of all slave nodes at the second state [force]

  /// Adds the nodes of one contact pair on this rank, in the same order in both states.
  void add(const std::vector<SlaveForce> &before, const std::vector<SlaveForce> &after);

  /// Returns the part of the contact force that the changes carry, at most 1; 0 without changes.
  double part() const;
};

} // namespace billet

#endif
