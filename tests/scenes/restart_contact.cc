// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs that stop and go on, as in restart.cc: an elastic block is pressed onto another one and dragged over
// it with friction, node against facet, and facet against facet with an augmented Lagrangian; a block falls
// onto a floor and is hit by a hammer, by implicit dynamics.
#include "restart_run.h"

#include <deal.II/base/mpi.h>

namespace restart_contact_test {

using namespace billet;
using billet::testing::check;
using billet::testing::History;

namespace {

const auto until_then = [](auto &run, const double time, History &history) { run.run(time, history); };

/// The blocks slide where they stop.
void test_blocks(const std::string &name, const parameters::Scene &scene) {
  double slip = 0., friction = 0.;
  testing::test_going_on<testing::ImplicitSolutionRun>(
      name, scene, {1.4}, [&](auto &run, const double time, History &history) {
        run.run(time, history);
        friction = run.problem.state().energies.friction;
        if (time == 1.4) {
          const auto reports = run.problem.report_contacts();
          for (const auto &node : reports[0])
            slip += node.status == ContactStatus::slip ? node.area : 0.;
        }
      });
  check(name + ": they slide", slip > 1.);
  check(name + ": friction", friction > 0.);
}

} // namespace

BILLET_MPI_TEST(restart_contact) {
  parameters::Scene blocks = testing::read_test_scene("restart_blocks.prm");
  blocks.solver.force_tolerance = 1e-11;
  test_blocks("Blocks", blocks);
  blocks.pairs[0].facets.method.value = FacetMethod::overlap;
  blocks.pairs[0].penetration_tolerance = 1e-4;
  test_blocks("Augmented overlaps", blocks);

  parameters::Scene drop = testing::read_test_scene("../cli/drop.prm");
  drop.solver.force_tolerance = 1e-11;
  if (testing::n_ranks() == 1) // on others, steps that follow the error differ in their last bits
    testing::test_going_on<testing::ImplicitSolutionRun>("Drop", drop, {0.1e-3, 0.3e-3}, until_then);
  testing::set_fixed_steps(drop, 25);
  drop.implicit_dynamics.error_tolerance = 0.;
  testing::test_going_on<testing::ImplicitSolutionRun>("Drop in fixed steps", drop, {0.11e-3, 0.31e-3},
                                                       until_then);
}

} // namespace restart_contact_test
