// SPDX-License-Identifier: LGPL-2.1-or-later
// What friction dissipates in implicit dynamics is the energy that bodies lose by it, also where they hop: a
// block that slides or spins to rest, by each method; one on a slope,
// one on an elastic slab.
#include "implicit_run.h"
#include "materials.h"

#include "../loads/make_load.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace friction_account_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

constexpr double mass = 5e-4, weight = 50. * mass, friction = 0.3, energy = 0.5 * mass * 0.6 * 0.6;

struct Result {
  double dissipated, lost, kinetic, numerical, drift; ///< energies at the end
  double way;                                         ///< of the block along x
};

Result run(const parameters::Scene &scene, const std::string &name) {
  SceneRun run(scene);
  const SolutionState &state = run.problem.state();
  const double initial = state.energies.kinetic;
  run.finish();
  const EnergyLedger &energies = state.energies;
  const Result result{
      energies.friction, initial + energies.external - energies.kinetic - energies.elastic - energies.contact,
      energies.kinetic,  energies.numerical,
      energies.drift(),  testing::mean_of_body(run, state.displacements)[0]};
  if (std::getenv("SHOW") != nullptr)
    std::cout << name << " friction " << result.dissipated << " lost " << result.lost << " kinetic "
              << result.kinetic << " numerical " << result.numerical << " drift " << result.drift << " way "
              << result.way << " iterations " << run.n_iterations << std::endl;
  check(name + ": friction takes what is lost", std::abs(result.dissipated / result.lost - 1.), 0.02);
  return result;
}

} // namespace

BILLET_MPI_TEST(friction_account) {
  const parameters::Scene block = testing::read_test_scene("friction_account.prm");
  using Set = std::function<void(parameters::Scene &)>;
  const std::vector<std::pair<std::string, Set>> methods{
      {"Newmark", testing::set_newmark},
      {"HHT", [](parameters::Scene &scene) { testing::set_hht(scene, -0.05); }},
      {"generalised-alpha", [](parameters::Scene &scene) { testing::set_generalised(scene, 0.8); }}};
  for (const auto &[name, set] : methods) {
    parameters::Scene scene = block;
    set(scene);
    const Result slides = run(scene, name + ", sliding");
    check("  all of the energy", std::abs(slides.dissipated / energy - 1.), 0.02);
    check("  until it rests", slides.kinetic / energy, 1e-3);
    check("  after v²/(2 μ g)", std::abs(slides.way / (energy / (friction * weight)) - 1.), 0.03);

    if (name != "generalised-alpha")
      continue;
    // Down a slope: the force of friction over the way.
    scene.bodies[0].initial_velocity.value = {"0", "0", "0"};
    scene.bodies[0].loads = {testing::make_load("acceleration", "set Acceleration = 35 ; 0 ; -50")};
    scene.time_stepping.end_time = 0.05;
    // Where it hops at the end the mean of N is not its weight, and the last bit decides whether it does.
    std::array<double, 3> errors{};
    const double modulus = testing::young_modulus(scene.bodies[0].material);
    for (std::size_t i = 0; i < errors.size(); ++i) {
      testing::set_young_modulus(scene.bodies[0].material,
                                 (0.999 + 0.001 * static_cast<double>(i)) * modulus);
      const Result slope = run(scene, name + ", on a slope");
      errors[i] = std::abs(slope.dissipated / (friction * weight * slope.way) - 1.);
    }
    std::sort(errors.begin(), errors.end());
    check("  μ N over its way, by the median of three moduli", errors[1], 0.02);
  }

  parameters::Scene top = block;
  testing::set_generalised(top, 0.8);
  top.bodies[0].initial_velocity.value = {"-19*y", "19*x", "0"};
  top.time_stepping.end_time = 0.15;
  run(top, "spinning");

  parameters::Scene bodies = testing::read_test_scene("friction_account_of_bodies.prm");
  bodies.pairs[0].facets.method.value = FacetMethod::planed; // which take half as long as overlaps
  const Result on_slab = run(bodies, "on an elastic slab");
  check("  all of the energy", std::abs(on_slab.dissipated / (0.125 * mass) - 1.), 0.02);
}

} // namespace friction_account_test
