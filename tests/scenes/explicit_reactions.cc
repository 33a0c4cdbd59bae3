// SPDX-License-Identifier: LGPL-2.1-or-later
// Reactions of explicit scenes: the sum of reactions, contact forces, loads and inertia is round-off, and the
// forces of pairs are those of their tools.
#include "explicit_run.h"

namespace explicit_reactions_test {

using namespace billet;
using billet::testing::check;
using billet::testing::WorstError;

namespace {

/// Steps through the first part of a scene, and checks the balance of its forces. `is_loaded`: whether forces
/// from outside act by then, without which the sums would show little.
void balance(const std::string &name, const bool is_loaded) {
  const parameters::Scene parameters = testing::read_test_scene(name + ".prm");
  testing::ExplicitRun run(parameters);
  ExplicitDynamics &problem = run.problem;
  const double end = parameters.time_stepping.end_time;
  WorstError defect, pairs, free;
  double largest = 0.;
  constexpr unsigned int n_steps = 400, interval = 20;
  for (unsigned int step = 0; step < n_steps && problem.time() < end; ++step) {
    problem.prepare_step(end);
    if (step % interval == 0) {
      problem.update_ledger();
      const Reactions &reactions = problem.reactions();
      const ForceBalance &forces = reactions.balance;
      defect.add(forces.defect());
      largest = std::max(largest, std::max({forces.reactions.norm(), forces.contact.norm(),
                                            forces.loads.norm(), forces.inertia.norm()}) /
                                      std::max(forces.size, 1e-300));
      free.add(reactions.balance.size > 0. ? reactions.balance.free.norm() / reactions.balance.size : 0.);
      std::vector<dealii::Tensor<1, 3>> of_tools(run.scene.tools().size());
      for (std::size_t i = 0; i < run.scene.pairs().size(); ++i)
        of_tools[run.scene.pairs()[i].tool] += reactions.of_tool_pairs[i].force;
      for (std::size_t i = 0; i < of_tools.size(); ++i)
        pairs.add((of_tools[i] - problem.state().tool_loads[i].force).norm() /
                  std::max(reactions.balance.size, 1e-300));
    }
    problem.finish_step();
  }
  check(name + ": forces balance", is_loaded && !(largest > 1e-6) ? 1. : defect.value(), 1e-12);
  check(name + ": constraints take all of the residual at their nodes", free.value(), 1e-14);
  check(name + ": forces of pairs are those of tools", pairs.value(), 1e-14);
}

} // namespace

BILLET_MPI_TEST(explicit_reactions) {
  for (const std::string name : {"contact_patch", "elastic_bar", "expanding_rings", "explicit_ranks",
                                 "hard_blow", "held_ring", "light_tool", "sliding_block"})
    balance(name, true);
  for (const std::string name : {"block_and_slab", "restart_ring", "springback", "two_bars"})
    balance(name, false);
}

} // namespace explicit_reactions_test
