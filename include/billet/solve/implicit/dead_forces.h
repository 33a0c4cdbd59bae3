// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_DEAD_FORCES_H
#define BILLET_SOLVE_IMPLICIT_DEAD_FORCES_H

#include "billet/discretization/support_reactions.h"

#include <vector>

namespace billet {

/// Forces of fixed sizes and directions at nodes of the bodies.
class DeadForces {
public:
  /// `forces`: on the bodies, of owned dofs [force].
  DeadForces(const Discretization &discretization, Vector forces);

  const Vector &at_nodes() const { return forces_; }
  /// Returns their resultant at these displacements of owned dofs, at least. Collective.
  Resultant resultant(const Vector &displacements) const;

private:
  /// Node with a force.
  struct Site {
    std::size_t place; ///< of its first component among the owned dofs
    dealii::Point<3> position;
  };
  const Discretization &discretization_;
  Vector forces_;
  std::vector<Site> sites_; ///< owned, in the order of dofs
};

} // namespace billet

#endif
