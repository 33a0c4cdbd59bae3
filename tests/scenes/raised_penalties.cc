// SPDX-License-Identifier: LGPL-2.1-or-later
// Penalties that rise in implicit dynamics, with tools and between bodies, (L8) of doc/theory.md: the force
// of a column is that of rigid contact, and no step rattles.
#include "implicit_run.h"

#include <deal.II/base/mpi.h>

#include <cmath>

namespace raised_penalties_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

struct Result {
  double force, ram_force, drift, numerical, kinetic;
  unsigned int n_steps;
};

Result press(const std::function<void(parameters::ContactPair &)> &change) {
  parameters::Scene parameters = testing::read_test_scene("raised_penalties.prm");
  for (auto &pair : parameters.pairs)
    change(pair);
  SceneRun run(parameters);
  const SolutionState &state = run.problem.state();
  double max_kinetic = 0.;
  run.finish([&](const NewtonReport &) { max_kinetic = std::max(max_kinetic, state.energies.kinetic); });
  const double energy = state.energies.total();
  return {state.tool_loads[0].force[2],
          -state.tool_loads[1].force[2],
          std::abs(state.energies.drift()) / energy,
          std::abs(state.energies.numerical) / energy,
          max_kinetic / energy,
          run.control.n_steps()};
}

} // namespace

BILLET_MPI_TEST(raised_penalties) {
  // Uniaxial strain in Hencky's law: τ = (κ + 4/3 G) ln λ, and the force is τ A_0/λ.
  constexpr double E = 200e3, nu = 0.3, area = 2.25, stretch = 0.998;
  const double modulus = E * (1. - nu) / ((1. + nu) * (1. - 2. * nu)),
               exact = -area * modulus * std::log(stretch) / stretch;
  const auto error = [&](const double force) { return std::abs(std::abs(force) / exact - 1.); };
  const Result raised = press([](auto &) {}),
               soft = press([](auto &pair) { pair.penetration_tolerance = 0.; });
  if (std::getenv("SHOW") != nullptr)
    for (const Result &r : {raised, soft})
      std::cout << r.force / exact << " " << r.ram_force / exact << " drift " << r.drift << " numerical "
                << r.numerical << " kinetic " << r.kinetic << " steps " << r.n_steps << std::endl;
  check("a column bears what it should", error(raised.force), 5e-3);
  check("and the ram presses as much", error(raised.ram_force), 5e-3);
  check("penalties that stay take much of that", error(soft.force) > 0.1);
  check("the motion stays slow", raised.kinetic, 1e-3);
  check("in few steps", raised.n_steps <= 3 * soft.n_steps);
  check("energy", raised.drift, 1e-3);
  check("of which raises take little", raised.numerical, 5e-3);
}

} // namespace raised_penalties_test
