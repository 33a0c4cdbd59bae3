// SPDX-License-Identifier: LGPL-2.1-or-later
// A ring and a hollow block are pressed until their insides touch themselves, and released. All is elastic
// and without friction, so that forces and energies are functions of the travel alone: the same on the way
// back as on the way there, while the insides touch, too. The work done is that energy, and comes back.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace folding_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using billet::testing::WorstError;

namespace {

struct FoldState {
  double force, energy, work, area;
};

/// Steps end at the multiples of 1/n, and may be cut on the way.
void set_grid(parameters::Scene &parameters, const unsigned int n) {
  parameters.time_stepping.initial_step = parameters.time_stepping.max_step = 1. / n;
  parameters.output.interval = 1. / n;
}

bool is_on_grid(const double time, const unsigned int n) {
  return std::abs(time * n - std::round(time * n)) < 1e-6;
}

/// `n` steps on each way, or more. The third pair is that of the inside.
void test(const std::string &name, const std::string &scene, const unsigned int n, const FacetMethod facets) {
  parameters::Scene parameters = testing::read_shipped_scene(scene);
  parameters.pairs[2].facets.method.value = facets;
  if (scene == "hollow_block.prm") // two thirds of the scene's elements each way
    parameters.bodies[0].mesh.arguments = "4, 1, 32 : 0, 0, -90 : 1, 1, 90 : true";
  for (auto &pair : parameters.pairs)
    pair.penetration_tolerance = 0.; // springs alone know no history
  for (auto &amplitude : parameters.amplitudes)
    if (scene == "ring_crush.prm") { // faster until the inside comes near itself
      amplitude.times = {0., 0.5, 1., 1.5, 2., 2.1};
      amplitude.values = {0., -13., -18.8, -13., 0., 0.5};
    }
  set_grid(parameters, n);
  SceneRun run(parameters);
  std::vector<FoldState> states{{0., 0., 0., 0.}};
  run.finish([&](const NewtonReport &) {
    const SolutionState &state = run.problem.state();
    if (is_on_grid(state.time, n))
      states.push_back({-state.tool_loads[0].force[2], state.energies.elastic + state.energies.contact,
                        state.energies.external, state.body_pair_loads[0].area});
  });
  const FoldState pressed = states[n];
  const auto first =
      std::find_if(states.begin(), states.end(), [](const FoldState &s) { return s.area > 0.; });
  check(name + ": the inside touches itself, but not at first",
        first - states.begin() > n / 5 && first - states.begin() < n);
  WorstError force, energy;
  for (unsigned int i = 1; i < n; ++i) {
    force.add(std::abs(states[n + i].force - states[n - i].force) / pressed.force);
    energy.add(std::abs(states[n + i].energy - states[n - i].energy) / pressed.energy);
  }
  check(name + ": force on the way back", force.value(), 1e-4);
  check(name + ": energy on the way back", energy.value(), 1e-5);
  check(name + ": work done", std::abs(pressed.work / pressed.energy - 1.), 0.01);
  check(name + ": work given back", std::abs(states.back().work) / pressed.work, 0.01);
  check(name + ": no energy is left", states.back().energy / pressed.energy, 1e-12);
  const auto reports = run.problem.report_contacts();
  bool is_open = true;
  for (const auto &node : reports[2])
    is_open = is_open && node.status == ContactStatus::open && node.traction.norm() == 0.;
  check(name + ": the inside is open", is_open && !reports[2].empty());
  WorstError left;
  for (const auto &load : run.problem.state().tool_loads)
    left.add(load.force.norm() / pressed.force);
  check(name + ": no force is left", left.value(), 1e-9);
}

/// With friction on the inside the work done is what is stored and what friction takes; at the end the inside
/// is open, and nothing holds on.
void test_with_friction(const std::string &name, const std::string &scene, const unsigned int n) {
  parameters::Scene parameters = testing::read_shipped_scene(scene);
  parameters.pairs[2].friction = make_coulomb(0.3);
  parameters.pairs[2].facets.method.value = FacetMethod::planed;
  parameters.time_stepping.initial_step = parameters.time_stepping.max_step = 1. / n;
  SceneRun run(parameters);
  double max_force = 0., max_stored = 0.;
  run.finish([&](const NewtonReport &) {
    const SolutionState &state = run.problem.state();
    max_force = std::max(max_force, -state.tool_loads[0].force[2]);
    max_stored = std::max(max_stored, state.energies.elastic);
  });
  const SolutionState &end = run.problem.state();
  check(name + ": friction has worked", end.energies.friction > 0.);
  check(name + ": which is the work that is lost",
        std::abs(end.energies.external - end.energies.friction) / max_stored, 0.01);
  check(name + ": no energy is left", end.energies.elastic / max_stored, 1e-12);
  bool is_open = true;
  const auto reports = run.problem.report_contacts();
  for (const auto &node : reports[2])
    is_open = is_open && node.status == ContactStatus::open && node.traction.norm() == 0.;
  check(name + ": the inside is open", is_open);
  check(name + ": no force is left", end.tool_loads[0].force.norm() / max_force, 1e-9);
}

/// Each end of a ring is a side of a pair of the ring with itself.
void test_two_sides() {
  SceneRun run(parameters::Scene::read(std::string(SOURCE_DIR) + "/open_ring.prm"));
  double time_of_touch = 0.;
  run.finish([&](const NewtonReport &) {
    const SolutionState &state = run.problem.state();
    if (time_of_touch == 0. && state.body_pair_loads[0].area > 0.)
      time_of_touch = state.time;
  });
  check("open ring: its ends come to touch", time_of_touch > 0.3 && time_of_touch <= 1.);
}

} // namespace

BILLET_MPI_TEST(folding) {
  using Facets = FacetMethod;
  test("ring, overlap", "ring_crush.prm", 16, Facets::overlap);
  test("ring, planed", "ring_crush.prm", 16, Facets::planed);
  test("block, overlap", "hollow_block.prm", 10, Facets::overlap);
  test_with_friction("ring, friction", "ring_crush.prm", 12);
  test_two_sides();
}

} // namespace folding_test
