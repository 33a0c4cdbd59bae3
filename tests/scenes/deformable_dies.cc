// SPDX-License-Identifier: LGPL-2.1-or-later
// The billet between elastic dies: its force comes to that of rigid dies as they grow stiff. Dies that leave
// unload it elastically, and nothing touches any more.
#include "materials.h"
#include "scene_run.h"

#include <deal.II/base/mpi.h>

namespace deformable_dies_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

constexpr unsigned int n = 10; ///< steps of the upsetting by half as much as in the scene

/// Forces on the billet after each step.
std::vector<double> rigid_forces() {
  parameters::Scene parameters = testing::read_shipped_scene("billet_upsetting.prm");
  parameters.time_stepping.end_time = 0.5;
  testing::set_fixed_steps(parameters, n);
  SceneRun run(parameters);
  std::vector<double> forces;
  run.finish([&](const NewtonReport &) { forces.push_back(run.load().force[2]); });
  return forces;
}

parameters::Scene read_scene(const double ratio) {
  parameters::Scene parameters = testing::read_shipped_scene("billet_deformable_dies.prm");
  for (auto &body : parameters.bodies)
    if (body.name == "die") {
      body.mesh.arguments = "4, 4, 1 : 0, 0, 15 : 20, 20, 25 : true";
      testing::set_young_modulus(body.material, ratio * 200e3);
    }
  return parameters;
}

/// The mean difference from the rigid dies' force, as part of it: rings of nodes that fold onto dies, one at
/// a time, do so a little earlier or later.
double difference(const double ratio, const std::vector<double> &rigid) {
  parameters::Scene parameters = read_scene(ratio);
  parameters.time_stepping.end_time = 0.5;
  parameters.time_stepping.stops.clear();
  testing::set_fixed_steps(parameters, n);
  SceneRun run(parameters);
  double sum = 0.;
  unsigned int i = 0;
  run.finish([&](const NewtonReport &) {
    sum += std::abs(run.problem.state().body_pair_loads[0].force[2] / rigid[i++] - 1.);
  });
  return i == n ? sum / n : NAN;
}

} // namespace

BILLET_MPI_TEST(deformable_dies) {
  const std::vector<double> rigid = rigid_forces();
  const double soft = difference(1., rigid), stiff = difference(1000., rigid);
  check("dies as stiff as the billet press less", soft > 2. * stiff);
  check("stiff dies press as rigid ones", stiff, 0.001);

  parameters::Scene released = read_scene(100.); // after half of the scene's way
  for (auto &amplitude : released.amplitudes)
    if (amplitude.name == "down") {
      amplitude.times = {0., 0.5, 0.6};
      amplitude.values = {0., -4.8, -3.8};
    }
  released.time_stepping.stops = {0.5};
  released.time_stepping.end_time = 0.6;
  SceneRun run(released);
  double plastic = 0., stored = 0.;
  run.finish([&](const NewtonReport &) {
    const EnergyLedger &energies = run.problem.state().energies;
    if (run.problem.state().time < 0.5 + 1e-9) {
      plastic = energies.plastic;
      stored = energies.elastic;
    }
  });
  const SolutionState &state = run.problem.state();
  check("unloading is elastic", std::abs(state.energies.plastic / plastic - 1.), 1e-9);
  check("some stress is left in the billet",
        state.energies.elastic > 0. && state.energies.elastic < 0.2 * stored);
  const auto reports = run.problem.report_contacts();
  bool is_open = !reports[0].empty();
  for (const auto &node : reports[0])
    is_open = is_open && node.status == ContactStatus::open && node.traction.norm() == 0.;
  check("the dies have left", is_open && state.body_pair_loads[0].force.norm() == 0.);
}

} // namespace deformable_dies_test
