// SPDX-License-Identifier: LGPL-2.1-or-later
// A failed try leaves no trace: the run that is made to fail, by a step far too long, goes on with the same
// bits as the one that never tried.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

namespace roll_back_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

bool same_bits(SceneRun &a, SceneRun &b) {
  Vector x = a.discretization.make_owned_vector(), y = b.discretization.make_owned_vector();
  x = a.problem.state().displacements;
  y = b.problem.state().displacements;
  for (const auto i : a.discretization.owned_dofs())
    if (x(i) != y(i))
      return false;
  const EnergyLedger &e = a.problem.state().energies, &f = b.problem.state().energies;
  return a.load().force == b.load().force && e.elastic == f.elastic && e.plastic == f.plastic &&
         e.friction == f.friction && e.external == f.external;
}

} // namespace

BILLET_MPI_TEST(roll_back) {
  parameters::Scene parameters = testing::read_shipped_scene("billet_upsetting.prm");
  testing::set_fixed_steps(parameters, 20);
  parameters.solver.max_iterations = 8;
  SceneRun untried(parameters), tried(parameters);
  bool failed = true, same = true, first_guess = false, correction = false, iterations = false;
  for (unsigned int step = 0; step < 8; ++step) {
    // Past the tool's end, and through the billet: det F <= 0, or too many iterations.
    const NewtonReport report =
        tried.problem.step(tried.control.time() + (step % 2 == 0 ? 1.45 : 0.45), step == 0 ? 0. : 0.05);
    failed = failed && !report.converged;
    first_guess = first_guess || report.failure.find("initial guess is not admissible") != std::string::npos;
    correction = correction || report.failure.find("correction leads to inadmissible") != std::string::npos;
    iterations = iterations || report.failure.find("iterations") != std::string::npos;
    untried.advance();
    tried.advance();
    same = same && same_bits(untried, tried);
  }
  check("the long steps fail", failed);
  check("some because an element is inside out at the start", first_guess);
  check("some because a correction would turn it", correction);
  check("some because of too many iterations", iterations);
  check("the short ones have the same bits as without them", same);
}

} // namespace roll_back_test
