// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_STABILITY_WATCH_H
#define BILLET_SOLVE_STABILITY_WATCH_H

#include "billet/diagnostics.h"
#include "billet/discretization/discretization.h"
#include "billet/material/stability.h"
#include "billet/scene/scene.h"

#include <cstddef>
#include <string>
#include <vector>

namespace billet {

/// Says once of each elastic body when it is strained farther than its law is stable, theory (M7): where
/// waves grow in it, what the body does is the mesh's. Looks into the middles of the elements; bodies that
/// yield, whose elastic strains are small, are left out.
class StabilityWatch {
public:
  StabilityWatch(const Scene &scene, const Discretization &discretization);

  /// Messages at these (ghosted) displacements, one for each body that has lost its stability for the first
  /// time. Collective.
  DiagnosticList check(double time, const Vector &displacements);
  /// Whether a body has been found so.
  bool has_unstable_bodies() const { return has_unstable_bodies_; }

private:
  struct Watched {
    std::size_t body;
    std::string name;
    std::shared_ptr<const PointLaw> law;
    bool is_unstable;
  };
  struct Weakest {
    double stiffness; ///< over the shear modulus
    Stretches stretches;
  };
  /// Of all ranks.
  Weakest find_weakest(const Watched &watched, const Vector &displacements) const;

  const Discretization &discretization_;
  std::vector<Watched> bodies_;
  bool has_unstable_bodies_ = false;
};

} // namespace billet

#endif
