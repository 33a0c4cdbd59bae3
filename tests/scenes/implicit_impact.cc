// SPDX-License-Identifier: LGPL-2.1-or-later
// An elastic bar on a rigid wall by implicit dynamics, against the wave solution that the explicit scheme is
// held to, too: it touches once, from 20 to 100 µs, with the force ρ c v A = 1.6 MN, and flies back.
#include "implicit_run.h"

#include <deal.II/base/mpi.h>

#include <cstdlib>

namespace implicit_impact_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

struct Impact {
  double begin = 0., rise = 0., fall = 0., force = 0., lowest = 1e30, highest = 0., rebound = 0., drift = 0.,
         numerical = 0.;
  unsigned int n_contacts = 0, n_steps = 0, n_cuts = 0;
};

parameters::Scene make_scene() {
  parameters::Scene scene = testing::read_test_scene("elastic_bar.prm");
  scene.bodies[0].mesh.arguments = "30, 1, 1 : 0.002, 0, 0 : 0.202, 0.02, 0.02 : true";
  auto &stepping = scene.time_stepping;
  stepping.scheme = parameters::TimeStepping::Scheme::implicit_dynamics;
  stepping.control = parameters::TimeStepping::Control::fixed;
  stepping.initial_step = 0.95e-6;
  scene.implicit_dynamics.error_tolerance = 0.;
  return scene;
}

Impact run(const parameters::Scene &scene) {
  SceneRun bar(scene);
  const SolutionState &state = bar.problem.state();
  const double momentum = state.momentum[0], energy = state.energies.initial;
  Impact impact;
  unsigned int n_on_plateau = 0;
  double last_time = 0., last_force = 0.;
  bar.finish([&](const NewtonReport &) {
    const double t = state.time, force = bar.load().force[0];
    if (force > 0. && last_force == 0.) {
      ++impact.n_contacts;
      if (impact.begin == 0.)
        impact.begin = t;
    }
    constexpr double half = 0.8e6;
    if ((force > half) != (last_force > half))
      (force > half ? impact.rise : impact.fall) =
          last_time + (t - last_time) * (half - last_force) / (force - last_force);
    last_time = t;
    last_force = force;
    if (t > 40e-6 && t < 80e-6) {
      impact.force += force;
      impact.lowest = std::min(impact.lowest, force);
      impact.highest = std::max(impact.highest, force);
      ++n_on_plateau;
    }
    impact.drift = std::max(impact.drift, std::abs(state.energies.drift()) / energy);
  });
  impact.force /= n_on_plateau;
  impact.rebound = -state.momentum[0] / momentum;
  impact.numerical = state.energies.numerical / energy;
  impact.n_steps = bar.control.n_steps();
  impact.n_cuts = bar.control.n_cuts();
  if (std::getenv("SHOW") != nullptr)
    std::cout << impact.begin << " " << impact.fall - impact.rise << " " << impact.force << " ["
              << impact.lowest << ", " << impact.highest << "] contacts " << impact.n_contacts << " rebound "
              << impact.rebound << " drift " << impact.drift << " numerical " << impact.numerical << " steps "
              << impact.n_steps << " cuts " << impact.n_cuts << " iterations " << bar.n_iterations
              << std::endl;
  return impact;
}

void check_impact(const std::string &name, const Impact &impact) {
  std::cout << name << ":" << std::endl;
  check("  touches after gap over velocity", std::abs(impact.begin / 20e-6 - 1.), 0.05);
  check("  lasts for two passages of the wave", std::abs((impact.fall - impact.rise) / 80e-6 - 1.), 0.02);
  check("  with the force of a wave", std::abs(impact.force / 1.6e6 - 1.), 0.02);
  check("  without ripples", (impact.highest - impact.lowest) / impact.force, 0.02);
  check("  once", impact.n_contacts == 1);
  check("  flies back with its momentum", std::abs(impact.rebound - 1.), 0.01);
  check("  energy", impact.drift, 2e-3);
}

} // namespace

BILLET_MPI_TEST(implicit_impact) {
  parameters::Scene scene = make_scene();
  check_impact("generalised-alpha", run(scene));
  testing::set_hht(scene, -0.2);
  check_impact("HHT", run(scene));
  // The nodes of the end swing on stiff penalties: the integrator damps that, or not.
  scene = make_scene();
  scene.pairs[0].penalty.normal = 30.;
  scene.bodies[0].mesh.arguments = "40, 1, 1 : 0.002, 0, 0 : 0.202, 0.02, 0.02 : true";
  scene.time_stepping.initial_step = 0.75e-6;
  scene.time_stepping.end_time = 90e-6; // the plateau is over
  const Impact damped = run(scene);
  testing::set_newmark(scene);
  const Impact undamped = run(scene);
  check("stiff penalty: half of the ripples of Newmark's method",
        damped.highest - damped.lowest < 0.5 * (undamped.highest - undamped.lowest));
  check("  which takes no energy", std::abs(undamped.numerical), 1e-6);

  scene = make_scene();
  scene.time_stepping.control = parameters::TimeStepping::Control::automatic;
  scene.time_stepping.initial_step = 1e-6;
  scene.time_stepping.min_step = 1e-9;
  scene.time_stepping.max_step = 20e-6;
  scene.time_stepping.few_iterations = 5;
  scene.time_stepping.many_iterations = 9;
  scene.time_stepping.growth_factor = 1.5;
  scene.time_stepping.shrink_factor = 0.7;
  scene.time_stepping.cut_factor = 0.5;
  scene.implicit_dynamics.error_tolerance = 5e-5;
  const Impact automatic = run(scene);
  check_impact("automatic steps", automatic);
  check("  cut where the wall is met", automatic.n_cuts > 0);
}

} // namespace implicit_impact_test
