// SPDX-License-Identifier: LGPL-2.1-or-later
// How long steps are: they change slowly, whatever contact and events ask for, and a tool's mass counts.
#include "explicit_run.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <vector>

namespace explicit_steps_test {

using namespace billet;
using billet::testing::check;

namespace {

/// Two cubes of 3 x 3 x 3 elements hit each other; one lands on the other.
parameters::Scene two_cubes(const double penalty) {
  parameters::Scene scene = testing::read_test_scene("block_and_slab.prm");
  for (auto &body : scene.bodies)
    body.mesh.arguments = "3, 3, 3 : 0, 0, 0 : 0.03, 0.03, 0.03 : true";
  for (unsigned int i = 0; i < 3; ++i)
    scene.bodies[1].mesh.translation[i] = i < 2 ? 0. : 0.0302;
  scene.bodies[1].initial_velocity.value = {"0", "0", "-50"};
  scene.pairs[0].penalty.normal = penalty;
  scene.pairs[0].facets.edges = parameters::ContactPair::Edges::free; // of nodes against facets
  scene.time_stepping.end_time = 0.00011;
  return scene;
}

/// Steps with stops in between.
void test_growth() {
  const parameters::Scene scene = two_cubes(1.);
  testing::ExplicitRun run(scene);
  testing::WorstError growth, drift;
  std::vector<double> steps;
  for (const double event : {1.03e-5, 2.9e-5, 1.1e-4})
    while (run.problem.time() < event) {
      run.problem.prepare_step(event);
      run.problem.update_ledger();
      drift.add(std::abs(run.problem.relative_drift()));
      steps.push_back(run.problem.step_length());
      run.problem.finish_step();
    }
  const double longest = *std::max_element(steps.begin(), steps.end());
  for (std::size_t i = 1; i < steps.size(); ++i)
    growth.add((steps[i] / steps[i - 1] - 1.) * (steps[i] / longest) * (steps[i] / longest));
  check("steps grow slowly, more slowly when they are long", growth.value(), 0.025);
  check("steps: stops are met", run.problem.time() == 1.1e-4);
  check("steps: energy", drift.value(), 8e-3);
}

/// A light tool falls on a cube and bounces, driven by a force. All of its energy is in the step in which it
/// enters, ¼ (ω Δt)² of which is the error of that step.
double drift_of_tool(const double tool_mass, const double resolution) {
  parameters::Scene scene = testing::read_test_scene("light_tool.prm");
  scene.tools[0].motion.inertia = tool_mass;
  scene.explicit_dynamics.contact_resolution = resolution;
  testing::ExplicitRun run(scene);
  double force = 0.;
  run.finish(1e-6, [&] { force = std::max(force, -run.state().tool_loads[0].force[2]); });
  return force > 100. ? run.worst_drift : 1e300; // it must hit
}

} // namespace

BILLET_MPI_TEST(explicit_steps) {
  test_growth();
  check("tool of 0.1 g: energy", drift_of_tool(1e-4, 2.), 0.14);
  check("tool of 0.1 g, finer steps: energy", drift_of_tool(1e-4, 8.), 0.02);
  check("tool of 10 g: energy", drift_of_tool(1e-2, 2.), 0.07);
  check("tool of 1 kg: energy", drift_of_tool(1., 2.), 0.01);
}

} // namespace explicit_steps_test
