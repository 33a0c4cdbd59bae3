// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_INERTIA_WATCH_H
#define BILLET_SOLVE_INERTIA_WATCH_H

#include "billet/diagnostics.h"
#include "billet/scene/scene.h"
#include "billet/solve/solution.h"
#include "billet/state.h"

#include <vector>

namespace billet {

/// Compares the kinetic energies of lumped and consistent masses, for the motion of each body
/// relative to its mean velocity. A bar of one brick across, for example, twists with three times
/// its inertia. Without lumped masses it does nothing.
class InertiaWatch {
public:
  InertiaWatch(const Scene &scene, const Discretization &discretization);

  /// Adds an accepted step; in explicit scenes a step now and then. Collective.
  void add(const SolutionState &state);

  /// Returns warnings. Bodies whose motion has little of `max_energy`, the largest energy in the
  /// run, are left out. Collective.
  DiagnosticList judge(double max_energy) const;

  void save(StateWriter &writer) const;
  /// Loads the sums; they start from zero if the earlier run did not save them.
  void load(const StateReader &reader);

  /// Lumped over consistent energy above which periods are off by 15 % or more. It is 1.5 in
  /// torsion with two bricks across, 1.7 in waves of three bricks' length.
  static constexpr double doubtful_ratio = 1.6;

private:
  const Scene &scene_;
  const Discretization &discretization_;
  bool is_lumped_;
  /// Time integrals of the energies, by body, over all ranks.
  std::vector<double> lumped_, consistent_;
  double time_ = 0., duration_ = 0.;
};

} // namespace billet

#endif
