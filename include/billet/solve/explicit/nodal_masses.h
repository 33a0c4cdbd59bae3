// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_NODAL_MASSES_H
#define BILLET_SOLVE_EXPLICIT_NODAL_MASSES_H

#include "billet/solve/explicit/explicit_elements.h"

#include <vector>

namespace billet {

/// Lumped masses of the nodes of a rank, including mass scaling.
class NodalMasses {
public:
  /// Scales the elements' masses so that none has a shorter stable step than `min_step` [time]; no
  /// scaling if it is 0. Collective.
  NodalMasses(const LocalNodes &nodes, ExplicitElements &elements, double min_step);

  /// Returns one mass for each node, the same on all its ranks [mass].
  const std::vector<double> &values() const { return values_; }
  const std::vector<double> &inverse() const { return inverse_; }
  /// Returns the mass of the bodies, on all ranks, without added mass [mass].
  double of_bodies() const { return of_bodies_; }
  /// Returns the mass that mass scaling adds, on all ranks [mass].
  double added() const { return added_; }

private:
  std::vector<double> values_, inverse_;
  double of_bodies_ = 0., added_ = 0.;
  HeldMemory memory_{Capability::inertia};
};

} // namespace billet

#endif
