// SPDX-License-Identifier: LGPL-2.1-or-later
// A block that slides on a rigid plane stops after v²/(2 μ g), and friction takes all of its kinetic energy;
// on several ranks it begins as on one.
#include "implicit_run.h"
#include "restart_run.h"

#include <deal.II/base/mpi.h>

#include <cstdlib>
#include <iomanip>

namespace implicit_sliding_test {

using namespace billet;
using billet::testing::SceneRun;

namespace {

/// Its first steps, on one rank and on all.
void compare_ranks(parameters::Scene scene) {
  scene.solver.force_tolerance = 1e-11;
  scene.time_stepping.end_time = 1e-3;
  testing::History on_one, on_all;
  const auto go = [&](const MPI_Comm some, testing::History &history) {
    testing::ImplicitSolutionRun run(scene, some);
    run.run(scene.time_stepping.end_time, history);
    std::vector<std::size_t> kinds;
    testing::numbers_of(run.problem.state(), &kinds);
    return kinds;
  };
  testing::on_ranks(1, [&](const MPI_Comm some) { go(some, on_one); });
  const auto kinds = go(MPI_COMM_WORLD, on_all);
  if (!testing::is_first_rank())
    return;
  testing::check("forces and energies as on one rank", testing::difference(on_one, on_all, kinds), 1e-8);
  testing::check("in twenty steps", on_all.size() == 20);
}

} // namespace

BILLET_MPI_TEST(implicit_sliding) {
  constexpr double friction = 0.25, gravity = 4000., full_weight = 2.5e-3;
  parameters::Scene scene = testing::read_test_scene("implicit_sliding.prm");
  scene.bodies[0].initial_velocity.value = {"3.5", "0", "0"};
  scene.time_stepping.end_time = 5e-3;
  scene.time_stepping.initial_step = 5e-5;
  if (testing::n_ranks() > 1)
    return compare_ranks(scene);
  SceneRun run(scene);
  const SolutionState &state = run.problem.state();
  const double initial = state.energies.kinetic;
  double start = 0., speed = 0., drift = 0.;
  run.finish([&](const NewtonReport &) {
    const auto u = testing::mean_of_body(run, state.displacements);
    const auto v = testing::mean_of_body(run, state.velocities);
    if (std::abs(state.time - full_weight) < 1e-9) {
      start = u[0];
      speed = v[0];
    }
    drift = std::max(drift, std::abs(state.energies.drift()) / initial);
  });
  const double way = testing::mean_of_body(run, state.displacements)[0] - start;
  const auto check = [](const auto &...arguments) { testing::check(arguments...); };
  if (std::getenv("SHOW") != nullptr)
    std::cout << speed << " " << way << " " << way / (speed * speed / (2. * friction * gravity)) << " "
              << state.energies.kinetic / initial << " " << state.energies.friction / initial << " "
              << state.energies.numerical / initial << " " << drift << " " << run.n_iterations << std::endl;
  check("slides fast where it is measured", speed > 1.5);
  check("way", std::abs(way / (speed * speed / (2. * friction * gravity)) - 1.), 0.005);
  check("comes to rest", state.energies.kinetic / initial, 1e-3);
  check("friction takes the energy", std::abs(state.energies.friction / initial - 1.), 0.005);
  check("energy", drift, 5e-3);
  std::cout << std::setprecision(6) << "way " << way << "\nfriction " << state.energies.friction
            << "\nnumerical dissipation " << state.energies.numerical << std::endl;
}

} // namespace implicit_sliding_test
