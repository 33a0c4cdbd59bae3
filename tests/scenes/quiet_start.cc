// SPDX-License-Identifier: LGPL-2.1-or-later
// A scene in which nothing moves yet has energies of round-off only, which do not balance: its drift must not
// stop the run. When the load comes the drift is what it would be without the wait, and energy from nowhere
// still shows.
#include "explicit_run.h"

#include <deal.II/base/mpi.h>

namespace quiet_start_test {

using namespace billet;
using billet::testing::check;

namespace {

struct Outcome {
  double drift_at_rest = 0., drift = 0., energy_at_rest = 0., energy = 0.;
};

Outcome run(const double max_drift) {
  parameters::Scene scene = testing::read_test_scene("quiet_start.prm");
  scene.explicit_dynamics.max_drift = max_drift;
  testing::ExplicitRun block(scene);
  Outcome outcome;
  block.finish(1e-6, [&] {
    const double drift = std::abs(block.problem.relative_drift());
    const double energy = block.state().energies.total();
    if (block.problem.time() < 0.5e-4) {
      outcome.drift_at_rest = std::max(outcome.drift_at_rest, drift);
      outcome.energy_at_rest = std::max(outcome.energy_at_rest, energy);
    }
    outcome.drift = drift;
    outcome.energy = energy;
  });
  return outcome;
}

} // namespace

BILLET_MPI_TEST(quiet_start) {
  for (const double max_drift : {0.05, 1e-3}) {
    const Outcome outcome = run(max_drift);
    const std::string allowed = max_drift > 0.01 ? "5 % allowed: " : "0.1 % allowed: ";
    check(allowed + "drift while nothing moves", outcome.drift_at_rest, 0.2 * max_drift);
    check(allowed + "drift when it moves", outcome.drift, 1e-4);
    check(allowed + "the smallest energy is round-off", outcome.energy_at_rest, 1e-12 * outcome.energy);
  }
}

} // namespace quiet_start_test
