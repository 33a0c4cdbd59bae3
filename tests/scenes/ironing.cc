// SPDX-License-Identifier: LGPL-2.1-or-later
// Shallow ironing: an elastic die is drawn over a softer slab. The ratio of horizontal to vertical force does
// not depend on how far it slides in a step, between 0.15 and 0.6 of a facet; a third of the
// scene's way runs without a failed step, and leaves nothing behind when the die has lifted off.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

namespace ironing_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

constexpr double size = 0.5, from = 0.6, slide = 1.2; // mm: facets; means are from `from` on
constexpr unsigned int n_press = 4;                   // steps

/// The shipped scene with a slab as long as the way needs.
parameters::Scene read_scene(const unsigned int n_facets, const unsigned int n_layers) {
  parameters::Scene parameters = testing::read_shipped_scene("ironing.prm");
  parameters.bodies[0].mesh.arguments = std::to_string(n_facets) + ", 1, " + std::to_string(n_layers) +
                                        " : 0, 0, 0 : " + std::to_string(size * n_facets) + ", 0.5, 3 : true";
  parameters.bodies[1].mesh.arguments = "8, 1, 3 : -2, 0, 0 : 2, 0.5, 1.5 : true";
  return parameters;
}

/// Horizontal over vertical force, means over the path, sliding so far in each step.
double force_ratio(const double step) {
  parameters::Scene parameters = read_scene(18, 3);
  const auto n = static_cast<unsigned int>(std::lround(slide / step));
  for (auto &amplitude : parameters.amplitudes)
    if (amplitude.name == "down") {
      amplitude.times = {0., n_press};
      amplitude.values = {0., -0.6};
    } else {
      amplitude.times = {n_press, static_cast<double>(n_press + n)};
      amplitude.values = {0., slide};
    }
  parameters.time_stepping.stops.clear();
  parameters.time_stepping.end_time = n_press + n;
  testing::set_fixed_steps(parameters, n_press + n);
  SceneRun run(parameters);
  double horizontal = 0., vertical = 0.;
  dealii::Tensor<1, 3> previous;
  run.finish([&](const NewtonReport &) {
    const dealii::Tensor<1, 3> &force = run.problem.state().body_pair_loads[0].force;
    if ((run.control.time() - n_press - 1.) * step > from - 1e-6) {
      horizontal -= 0.5 * (force[0] + previous[0]);
      vertical += 0.5 * (force[2] + previous[2]);
    }
    previous = force;
  });
  return horizontal / vertical;
}

} // namespace

BILLET_MPI_TEST(ironing) {
  const double short_steps = force_ratio(0.15 * size), long_steps = force_ratio(0.6 * size);
  check("ratio of forces, short and long steps", std::abs(long_steps / short_steps - 1.), 1e-3);

  parameters::Scene scene = read_scene(22, 4);
  for (auto &amplitude : scene.amplitudes)
    if (amplitude.name == "down")
      amplitude.times = {0., 1., 1.6, 2.1};
    else {
      amplitude.times = {1., 1.6};
      amplitude.values = {0., 3.};
    }
  scene.time_stepping.stops = {1., 1.6};
  scene.time_stepping.end_time = 2.1;
  scene.time_stepping.initial_step = scene.time_stepping.max_step = 0.1; // twice the scene's
  SceneRun run(scene);
  double lowest = 1., highest = 0., stored = 0., deepest = 0.;
  run.finish([&](const NewtonReport &) {
    const SolutionState &state = run.problem.state();
    const ContactLoad &load = state.body_pair_loads[0];
    if (state.time > 1.2 - 1e-9 && state.time < 1.5 + 1e-9) { // drawn by 1 to 2.5 mm
      lowest = std::min(lowest, -load.force[0] / load.force[2]);
      highest = std::max(highest, -load.force[0] / load.force[2]);
    }
    stored = std::max(stored, state.energies.elastic);
    deepest = std::max(deepest, load.deepest);
  });
  check("no step fails", run.control.n_cuts() == 0);
  check("ratio of forces along the path", highest / lowest - 1., 0.01);
  check("it is friction, and a little more for the wall of slab in front", lowest > 0.3 && highest < 0.32);
  check("the die sinks in by less than a tenth of a facet", deepest, 0.1 * size);

  const auto reports = run.problem.report_contacts();
  bool is_open = true;
  for (const auto &node : reports[0])
    is_open = is_open && node.status == ContactStatus::open && node.traction.norm() == 0.;
  check("lifted, nothing touches", is_open && run.problem.state().body_pair_loads[0].force.norm() == 0.);
  check("lifted, there is no stress", run.problem.state().energies.elastic / stored, 1e-12);
}

} // namespace ironing_test
