// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_STABILITY_WATCH_H
#define BILLET_SOLVE_STABILITY_WATCH_H

#include "billet/diagnostics.h"
#include "billet/discretization/discretization.h"
#include "billet/material/stability.h"
#include "billet/scene/scene.h"
#include "billet/solve/solution.h"

#include <cstddef>
#include <string>
#include <vector>

namespace billet {

/// Warns once for each elastic body that is strained beyond the stability of its law, (M7) of
/// doc/theory.md. Ellipticity is lost then, and results depend on the mesh. It checks the centres
/// of the elements. Bodies that yield, whose elastic strains are small, are left out.
class StabilityWatch {
public:
  StabilityWatch(const Scene &scene, const Discretization &discretization);

  /// Returns messages at this state, one for each body that has newly lost its stability.
  /// Collective.
  DiagnosticList check(const SolutionState &state);
  /// Whether any body has lost its stability.
  bool has_unstable_bodies() const { return has_unstable_bodies_; }

private:
  /// Range of principal stretches.
  struct Range {
    double least, largest;
  };
  struct Watched {
    std::size_t body;
    std::string name;
    std::shared_ptr<const PointLaw> law;
    Range safe; ///< in which the law is stable
    bool is_unstable;
  };
  struct Weakest {
    double stiffness; ///< over the shear modulus
    Stretches stretches;
  };
  /// Returns the largest of some ranges in which a law is stable; an empty one if it is stable in
  /// none.
  static Range find_safe_range(const PointLaw &law);
  /// Finds the weakest element of all ranks.
  Weakest find_weakest(const Watched &watched, const Vector &displacements) const;

  const Discretization &discretization_;
  std::vector<Watched> bodies_;
  bool has_unstable_bodies_ = false;
};

} // namespace billet

#endif
