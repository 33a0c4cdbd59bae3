// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_BOUNDS_H
#define BILLET_CONTACT_FACET_BOUNDS_H

#include "billet/contact/contact_load.h"
#include "billet/contact/facet_contact_parts.h"

#include <vector>

namespace billet {

/// What contact between surfaces adds to the bounds of explicit steps, after an evaluation.
class FacetBounds {
public:
  /// The parts have to outlive this.
  explicit FacetBounds(const FacetContactParts &parts) : parts_(parts) {}

  /// Adds to each of this rank's nodes what bounds the time step: the sum Σ_j |K_ij| of its row of the
  /// contact stiffness, 2 k A for a slave and 2 w_I k A for a facet's corner [force/length]. With the same
  /// sum of the elements, ω² <= max_i Σ_j |K_ij|/m_i. A slave straight before one of its candidates counts as
  /// if it touched it: a step that were shortened only when a node has entered would be too long for that
  /// entry. Collective.
  void add_row_sums(std::vector<double> &row_sums);
  /// Adds those of this rank's areas, before the step ends.
  void add_crossings(Crossings &crossings) const;

private:
  const FacetContactParts &parts_;
  std::vector<double> sums_; ///< of nodes with ghosts
};

} // namespace billet

#endif
