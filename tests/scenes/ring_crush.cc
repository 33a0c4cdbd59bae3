// SPDX-License-Identifier: LGPL-2.1-or-later
// A ring that is crushed until its inside touches itself, and released. All is elastic and without friction,
// so that the die's force and the energies are functions of its travel alone: the same on the way up as on
// the way down, contact of the inside included. The work of the die is that energy, and comes back.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using billet::testing::WorstError;

namespace {

constexpr unsigned int n = 100; ///< steps on each way

struct RingState {
  double force, energy, work, area;
};

void test(const std::string &name, const parameters::ContactPair::Facets facets) {
  parameters::Scene parameters = testing::read_shipped_scene("ring_crush.prm");
  parameters.pairs[2].facets.value = facets;
  parameters.time_stepping.control = parameters::TimeStepping::Control::fixed;
  parameters.time_stepping.initial_step = 1. / n;
  SceneRun ring(parameters);
  std::vector<RingState> states{{0., 0., 0., 0.}};
  ring.finish([&](const NewtonReport &) {
    const SolutionState &state = ring.problem.state();
    states.push_back({-state.tool_loads[0].force[2], state.energies.elastic + state.energies.contact,
                      state.energies.external, state.body_pair_loads[0].area});
  });
  const RingState crushed = states[n];
  const auto first =
      std::find_if(states.begin(), states.end(), [](const RingState &s) { return s.area > 0.; });
  check(name + ": the inside touches itself, late",
        first - states.begin() > n / 2 && first - states.begin() < n);
  WorstError force, energy;
  for (unsigned int i = 1; i < n; ++i) {
    force.add(std::abs(states[n + i].force - states[n - i].force) / crushed.force);
    energy.add(std::abs(states[n + i].energy - states[n - i].energy) / crushed.energy);
  }
  check(name + ": force on the way up", force.value(), 1e-4);
  check(name + ": energy on the way up", energy.value(), 1e-5);
  check(name + ": work of the die", std::abs(crushed.work / crushed.energy - 1.), 0.01);
  check(name + ": work is given back", std::abs(states.back().work) / crushed.work, 0.01);
  check(name + ": no energy is left", states.back().energy / crushed.energy, 1e-12);
  bool is_open = true;
  const auto reports = ring.problem.report_contacts();
  for (const auto &pair : reports)
    for (const auto &node : pair)
      is_open = is_open && node.status == ContactStatus::open && node.traction.norm() == 0.;
  check(name + ": nothing touches any more", is_open);
}

} // namespace

int main(int argc, char *argv[]) {
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  test("overlap", parameters::ContactPair::Facets::overlap);
  test("planed", parameters::ContactPair::Facets::planed);
  return testing::exit_code();
}
