// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_CROSSING_LIMIT_H
#define BILLET_SOLVE_EXPLICIT_CROSSING_LIMIT_H

#include "billet/solve/explicit/explicit_parts.h"

#include <limits>

namespace billet {

/// Maximum step for which nodes that come through surfaces cause a small error of energy.
class CrossingLimit {
public:
  explicit CrossingLimit(const ExplicitParts &parts) : parts_(parts) {}

  /// Computes the step at the last forces. Errors are measured against `energy`, or the kinetic
  /// energy of all bodies at the speed with which nodes come. Collective.
  void update(double stable_step, double energy);
  /// Returns that step; infinite if no node comes through a surface [time].
  double value() const { return value_; }
  /// Returns the longest step by (E5), from the springs of `step` [time]; see Crossings. `energy`:
  /// that of reference.
  static double longest_step(double step, double springs, double energy);

private:
  /// Nodes of this rank that come through surfaces in a step.
  struct Coming {
    Crossings crossings;
    double step;
    bool is_unknown; ///< the same on all ranks: only the first step shows the speed
  };
  Coming at_start(double stable_step) const;

  const ExplicitParts &parts_;
  double value_ = std::numeric_limits<double>::infinity();
};

} // namespace billet

#endif
