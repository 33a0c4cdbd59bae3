// SPDX-License-Identifier: LGPL-2.1-or-later
// The billet, on a coarser mesh, under half of the drop hammer: implicit and explicit dynamics agree in how
// deep it goes, in the force and in where the energy stays, and the energies balance.
#include "scene_run.h"

#include "explicit_run.h"

#include <deal.II/base/mpi.h>

#include <cstdlib>

namespace drop_hammer_test {

using namespace billet;
using billet::testing::check;

namespace {

struct Impact {
  double depth = 0., force = 0., drift = 0., speed = 0.;
  EnergyLedger energies;
};

void inspect(const SolutionState &state, Impact &impact) {
  impact.depth = std::max(impact.depth, -state.placements[1].translation[2]);
  impact.force = std::max(impact.force, state.tool_loads[1].force.norm());
  impact.drift = std::max(impact.drift, std::abs(state.energies.drift()));
  impact.energies = state.energies;
}

} // namespace

BILLET_MPI_TEST(drop_hammer) {
  parameters::Scene scene = testing::read_shipped_scene("drop_hammer.prm");
  scene.bodies[0].mesh.n_layers = 4;
  scene.tools[1].motion.inertia = 0.05;
  scene.time_stepping.end_time = 4.5e-3;
  Impact impact, quick;
  testing::SceneRun run(scene);
  run.finish([&](const NewtonReport &) { inspect(run.problem.state(), impact); });
  scene.time_stepping.scheme = parameters::TimeStepping::Scheme::explicit_dynamics;
  testing::ExplicitRun explicit_run(scene);
  explicit_run.finish(4e-5, [&] { inspect(explicit_run.state(), quick); });
  const double energy = 0.5 * 0.05 * 5000. * 5000.;
  if (std::getenv("SHOW") != nullptr)
    for (const Impact &b : {impact, quick})
      std::cout << b.depth << " " << b.force << " " << b.drift / energy << " " << b.energies.plastic / energy
                << " " << b.energies.friction / energy << " " << b.energies.numerical / energy << std::endl;
  check("depth", std::abs(impact.depth / quick.depth - 1.), 2e-3);
  check("force", std::abs(impact.force / quick.force - 1.), 0.01);
  check("plastic work", std::abs(impact.energies.plastic / quick.energies.plastic - 1.), 2e-3);
  check("energy", impact.drift / energy, 1e-3);
  check("numerical dissipation", std::abs(impact.energies.numerical) / energy, 1e-3);
  check("all of it in less than 200 steps", run.control.n_steps() < 200);
}

} // namespace drop_hammer_test
