// SPDX-License-Identifier: LGPL-2.1-or-later
// A cube hits a plate after a flight of 100 thicknesses: whatever the steps, it leaves the plate as after a
// short flight in short steps. A body that spins keeps its energy in long steps.
#include "implicit_run.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <cstdlib>

namespace late_impact_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

/// The cube's velocity away from the plate, 0.03 after the impact; it arrives with 1.
double leave(parameters::Scene scene, const double distance) {
  scene.bodies[1].mesh.translation[2] = distance;
  scene.time_stepping.end_time = distance + 0.03;
  SceneRun flight(scene);
  flight.finish();
  const double velocity = testing::mean_of_body(flight, flight.problem.state().velocities, 1)[2];
  if (std::getenv("SHOW") != nullptr)
    std::cout << "leaves with " << velocity << ", steps " << flight.control.n_steps() << " cuts "
              << flight.control.n_cuts() << std::endl;
  return velocity;
}

void test_impact() {
  const parameters::Scene scene = testing::read_test_scene("late_impact.prm");
  parameters::Scene close = scene;
  close.time_stepping.end_time = 0.04;
  testing::set_fixed_steps(close, 200);
  close.implicit_dynamics.error_tolerance = 0.;
  const double reference = leave(close, 0.01);
  const auto check_flight = [&](const char *const name, const double first, const double maximum,
                                const double tolerance) {
    parameters::Scene far = scene;
    far.time_stepping.initial_step = first;
    far.time_stepping.max_step = maximum;
    far.implicit_dynamics.error_tolerance = tolerance;
    check(name, std::abs(leave(far, 20.) - reference) / (1. + reference), 0.08);
  };
  check_flight("default tolerance, steps up to the whole flight", 0.2, 20.03, 1e-3);
  check_flight("the same without a tolerance", 0.2, 20.03, 0.);
  check_flight("and with the whole flight in the first step", 20.03, 20.03, 0.);
}

void test_spin() {
  parameters::Scene scene = testing::read_test_scene("late_impact.prm");
  scene.pairs.clear();
  scene.bodies[1].initial_velocity.value = {"2*(z - 0.26)", "0", "-1 - 2*x"};
  scene.time_stepping.end_time = 8.;
  scene.time_stepping.initial_step = scene.time_stepping.max_step = 2.;
  scene.implicit_dynamics.error_tolerance = 0.;
  SceneRun flight(scene);
  testing::WorstError drift;
  const SolutionState &state = flight.problem.state();
  flight.finish(
      [&](const NewtonReport &) { drift.add(std::abs(state.energies.drift()) / state.energies.initial); });
  if (std::getenv("SHOW") != nullptr)
    std::cout << "spin: steps " << flight.control.n_steps() << " cuts " << flight.control.n_cuts()
              << " drift " << drift.value() << std::endl;
  check("a body that turns by 16 radians keeps its energy", drift.value(), 0.025);
}

} // namespace

BILLET_MPI_TEST(late_impact) {
  test_impact();
  test_spin();
}

} // namespace late_impact_test
