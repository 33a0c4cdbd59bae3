// SPDX-License-Identifier: LGPL-2.1-or-later
// Two equal elastic bars, one of which flies onto the other, exchange their velocities by implicit dynamics,
// too; with surfaces that match and that do not.
#include "implicit_run.h"

#include <deal.II/base/mpi.h>

#include <cstdlib>

namespace implicit_two_bars_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using dealii::Tensor;

namespace {

void test(const unsigned int left_across, const unsigned int right_across) {
  parameters::Scene scene = testing::read_test_scene("two_bars.prm");
  const auto mesh = [](const unsigned int across) {
    return "24, " + std::to_string(across) + ", " + std::to_string(across);
  };
  scene.bodies[0].mesh.arguments = mesh(left_across) + " : -0.201, 0, 0 : -0.001, 0.02, 0.02 : true";
  scene.bodies[1].mesh.arguments = mesh(right_across) + " : 0, 0, 0 : 0.2, 0.02, 0.02 : true";
  scene.time_stepping.scheme = parameters::TimeStepping::Scheme::implicit_dynamics;
  scene.implicit_dynamics.error_tolerance = 0.;
  testing::set_fixed_steps(scene, 72);
  SceneRun bars(scene);
  const SolutionState &state = bars.problem.state();
  const double momentum = state.momentum[0], energy = state.energies.initial;
  double lost = 0., drift = 0., force = 0.;
  bars.finish([&](const NewtonReport &) {
    lost = std::max(lost, (state.momentum - Tensor<1, 3>({momentum, 0., 0.})).norm() / momentum);
    drift = std::max(drift, std::abs(state.energies.drift()) / energy);
    force = std::max(force, state.body_pair_loads[0].force.norm());
  });
  const Tensor<1, 3> left = testing::mean_of_body(bars, state.velocities, 0),
                     right = testing::mean_of_body(bars, state.velocities, 1);
  if (std::getenv("SHOW") != nullptr)
    std::cout << left << ", " << right << ", lost " << lost << " drift " << drift << " force " << force
              << " numerical " << state.energies.numerical / energy << " iterations " << bars.n_iterations
              << std::endl;
  std::cout << (left_across == right_across ? "matching:" : "not matching:") << std::endl;
  check("  the left one is at rest", left.norm() / 100., 0.02);
  check("  the right one flies", (right - Tensor<1, 3>({100., 0., 0.})).norm() / 100., 0.02);
  check("  with half the force of the wall", std::abs(force / 0.8e6 - 1.), 0.1);
  check("  parted", state.body_pair_loads[0].force.norm() == 0.);
  check("  momentum", lost, 1e-6);
  check("  energy", drift, 5e-3);
}

} // namespace

BILLET_MPI_TEST(implicit_two_bars) {
  test(1, 1);
  test(1, 2);
}

} // namespace implicit_two_bars_test
