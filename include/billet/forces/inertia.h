// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FORCES_INERTIA_H
#define BILLET_FORCES_INERTIA_H

#include "billet/discretization/local_nodes.h"
#include "billet/discretization/supports.h"
#include "billet/mechanics/element_mass.h"

#include <vector>

namespace billet {

/// Mass matrix of all bodies, element by element, without constraints.
class Inertia {
public:
  /// Computes the element masses. If `is_lumped`, row sums replace the consistent matrix. Elements
  /// must not be inverted.
  Inertia(const Scene &scene, const Discretization &discretization, bool is_lumped);

  /// Returns M x of a ghosted vector x, as an owned vector. Collective.
  Vector times(const Vector &ghosted) const;
  /// Adds `factor` M.
  void add_tangent(double factor, const TangentSystem &system) const;
  /// Returns this rank's share of the row sums at the nodes [mass].
  std::vector<double> nodal_masses(const LocalNodes &nodes) const;
  /// Returns the mass of all bodies, the same on all ranks [mass].
  double total() const { return total_; }

private:
  const Discretization &discretization_;
  std::vector<std::vector<ElementMass>> masses_; ///< by body and owned element
  double total_ = 0.;
};

} // namespace billet

#endif
