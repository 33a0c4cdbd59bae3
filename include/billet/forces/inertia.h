// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FORCES_INERTIA_H
#define BILLET_FORCES_INERTIA_H

#include "billet/discretization/local_nodes.h"
#include "billet/discretization/supports.h"
#include "billet/mechanics/element_mass.h"

#include <vector>

namespace billet {

/// The mass matrix of all bodies, element by element: it knows no constraints.
class Inertia {
public:
  /// `is_lumped`: row sums in place of the consistent matrix. Elements must not be inverted.
  Inertia(const Scene &scene, const Discretization &discretization, bool is_lumped);

  /// M x of a ghosted vector, as an owned one. Collective.
  Vector times(const Vector &ghosted) const;
  /// Adds `factor` M.
  void add_tangent(double factor, const TangentSystem &system) const;
  /// Row sums at the nodes, this rank's share [mass].
  std::vector<double> nodal_masses(const LocalNodes &nodes) const;
  /// Of all bodies, on all ranks the same.
  double total() const { return total_; }

private:
  const Discretization &discretization_;
  std::vector<std::vector<ElementMass>> masses_; ///< by body and owned element
  double total_ = 0.;
};

} // namespace billet

#endif
