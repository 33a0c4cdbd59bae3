// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_BOUNDS_H
#define BILLET_CONTACT_FACET_BOUNDS_H

#include "billet/contact/contact_load.h"
#include "billet/contact/facet_contact_parts.h"

#include <vector>

namespace billet {

/// Contribution of contact between surfaces to the bounds of explicit steps, after an evaluation.
class FacetBounds {
public:
  /// The parts must outlive this object.
  explicit FacetBounds(const FacetContactParts &parts) : parts_(parts) {}

  /// Adds the sum Σ_j |K_ij| of the contact stiffness, which bounds the time step, to each of this
  /// rank's nodes [force/length]. It is 2 k A for a slave and 2 w_I k A for a facet's corner. With
  /// the same sum of the elements, ω² <= max_i Σ_j |K_ij|/m_i.
  ///
  /// A slave directly in front of a candidate counts as touching. A step that is reduced only after
  /// the entry of a node is too long for that entry. Collective.
  void add_row_sums(std::vector<double> &row_sums);
  /// Adds the crossings with this rank's areas, before the step ends.
  void add_crossings(Crossings &crossings) const;

private:
  const FacetContactParts &parts_;
  std::vector<double> sums_; ///< of nodes, including ghosts
};

} // namespace billet

#endif
