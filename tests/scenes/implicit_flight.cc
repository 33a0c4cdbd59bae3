// SPDX-License-Identifier: LGPL-2.1-or-later
// A free block: its momentum is kept to round-off, its moment of momentum within an error of second order.
#include "implicit_run.h"

#include <deal.II/base/mpi.h>

namespace implicit_flight_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using billet::testing::WorstError;

namespace {

struct Flight {
  double momentum = 0., spin = 0., drift = 0., numerical = 0., path = 0.;
};

/// Half a turn and some way. The initial velocity of the block is that of a rigid body.
Flight fly(const unsigned int n_steps, const bool is_newmark) {
  parameters::Scene scene = testing::read_test_scene("implicit_block.prm");
  testing::set_fixed_steps(scene, n_steps);
  if (is_newmark)
    testing::set_newmark(scene);
  SceneRun run(scene);
  const SolutionState &state = run.problem.state();
  const auto p = state.momentum, L = state.angular_momentum;
  const double energy = state.energies.initial;
  WorstError momentum, spin, drift;
  run.finish([&](const NewtonReport &) {
    momentum.add((state.momentum - p).norm() / p.norm());
    spin.add((state.angular_momentum - L).norm() / L.norm());
    drift.add(std::abs(state.energies.drift()) / energy);
  });
  const auto way = testing::mean_of_body(run, state.displacements);
  return {momentum.value(), spin.value(), drift.value(), std::abs(state.energies.numerical) / energy,
          (way - scene.time_stepping.end_time * dealii::Tensor<1, 3>({3., -2., 1.})).norm()};
}

} // namespace

BILLET_MPI_TEST(implicit_flight) {
  for (const bool is_newmark : {true, false}) {
    const Flight coarse = fly(32, is_newmark), fine = fly(64, is_newmark);
    if (std::getenv("SHOW"))
      for (const auto &f : {coarse, fine})
        std::cout << f.momentum << " " << f.spin << " " << f.drift << " " << f.numerical << " " << f.path
                  << "\n";
    std::cout << (is_newmark ? "Newmark: " : "generalised-alpha: ") << std::endl;
    check("  momentum", std::max(coarse.momentum, fine.momentum), 1e-11);
    check("  path", std::max(coarse.path, fine.path), 1e-9);
    check("  moment of momentum", coarse.spin, 0.01);
    check("  ... error falls with the square of the step", std::abs(std::log2(coarse.spin / fine.spin) - 2.),
          0.2);
    check("  energy", std::max(fine.drift, fine.numerical), 1e-3);
  }
}

} // namespace implicit_flight_test
