// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_INERTIA_WATCH_H
#define BILLET_SOLVE_INERTIA_WATCH_H

#include "billet/diagnostics.h"
#include "billet/scene/scene.h"
#include "billet/solve/solution.h"
#include "billet/state.h"

#include <vector>

namespace billet {

/// Compares the kinetic energy that masses at the nodes have with that of the elements' shape functions, of
/// the motion of each body relative to its mean velocity: a bar of one brick across twists with three times
/// the inertia. Of scenes with lumped masses; in others it does nothing.
class InertiaWatch {
public:
  InertiaWatch(const Scene &scene, const Discretization &discretization);

  /// After an accepted step; of explicit scenes now and then. Collective.
  void add(const SolutionState &state);

  /// `largest_energy`: of all that counts in the run; bodies whose motion has little of it are left out.
  /// Collective.
  DiagnosticList judge(double largest_energy) const;

  void save(StateWriter &writer) const;
  /// Of a run that kept no such account it begins anew.
  void load(const StateReader &reader);

  /// Lumped over consistent energy from which on periods are off by 15 % and more: 1.5 in torsion with two
  /// bricks across, 1.7 in waves of three bricks' length.
  static constexpr double doubtful_ratio = 1.6;

private:
  const Scene &scene_;
  const Discretization &discretization_;
  bool is_lumped_;
  std::vector<double> lumped_, consistent_; ///< energies times time, by body, of all ranks
  double time_ = 0., duration_ = 0.;
};

} // namespace billet

#endif
