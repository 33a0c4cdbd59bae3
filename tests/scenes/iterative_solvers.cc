// SPDX-License-Identifier: LGPL-2.1-or-later
// Whole scenes by every linear solver: the same forces and displacements; Eisenstat and Walker's forcing
// costs few iterations of Newton's method beside exact solves, and spares linear ones.
#include "billet/diagnostic_kinds.h"
#include "scene_run.h"

#include <deal.II/base/mpi.h>

namespace iterative_solvers_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

struct Result {
  unsigned int iterations = 0, linear_iterations = 0;
  double force = 0.;
  std::vector<double> displacements; ///< of this rank
  DiagnosticList messages;
};

Result run(const parameters::Scene &parameters) {
  SceneRun scene(parameters);
  Result result;
  scene.finish([&](const NewtonReport &report) {
    result.linear_iterations += report.linear_iterations;
    append(result.messages, report.diagnostics);
  });
  result.iterations = scene.n_iterations;
  result.force = scene.scene.tools().empty() ? scene.problem.state().body_pair_loads[0].force.norm()
                                             : scene.load().force.norm();
  for (const auto dof : scene.discretization.owned_dofs())
    result.displacements.push_back(scene.problem.state().displacements(dof));
  return result;
}

double distance(const Result &a, const Result &b) {
  double difference = 0., size = 0.;
  for (std::size_t i = 0; i < a.displacements.size(); ++i) {
    difference = std::max(difference, std::abs(a.displacements[i] - b.displacements[i]));
    size = std::max(size, std::abs(b.displacements[i]));
  }
  return dealii::Utilities::MPI::max(difference, MPI_COMM_WORLD) /
         dealii::Utilities::MPI::max(size, MPI_COMM_WORLD);
}

/// `more`: by how many iterations Newton's method may differ between solvers that both are exact.
void compare(const std::string &name, const parameters::Scene &scene, const IterativeMethod iterative,
             const unsigned int more = 0) {
  parameters::Scene parameters = scene;
  parameters.solver.force_tolerance = 1e-8;
  parameters.solver.linear_solver.value = {};
  const Result direct = run(parameters);
  check(name + ", directly: no linear iterations, nothing to tell",
        direct.linear_iterations == 0 && direct.messages.empty());
  parameters.solver.linear_solver.value = iterative;
  parameters.solver.forcing = parameters::Solver::Forcing::fixed;
  parameters.solver.linear_tolerance = 1e-11;
  const Result exact = run(parameters);
  check(name + ", solved exactly: as many iterations of Newton's method",
        exact.iterations <= direct.iterations + more && direct.iterations <= exact.iterations + more);
  check(name + ", solved exactly: force", std::abs(exact.force / direct.force - 1.), 1e-8);
  check(name + ", solved exactly: displacements", distance(exact, direct), 1e-8);
  check(name + ", solved exactly: no direct solver",
        find(exact.messages, diagnostic::direct_solver) == nullptr);
  parameters.solver.forcing = parameters::Solver::Forcing::eisenstat_walker;
  parameters.solver.linear_tolerance = 1e-6;
  const Result forced = run(parameters);
  check(name + ", Eisenstat-Walker: force", std::abs(forced.force / direct.force - 1.), 1e-6);
  check(name + ", Eisenstat-Walker: displacements", distance(forced, direct), 1e-6);
  check(name + ", Eisenstat-Walker: at most half more iterations of Newton's method",
        2 * forced.iterations <= 3 * direct.iterations);
  check(name + ", Eisenstat-Walker: fewer linear iterations",
        forced.linear_iterations < exact.linear_iterations);
  parameters.solver.max_linear_iterations = 1;
  const Result helped = run(parameters);
  check(name + ", with a direct solver's help: force", std::abs(helped.force / direct.force - 1.), 1e-6);
  check(name + ", with a direct solver's help: reported",
        find(helped.messages, diagnostic::direct_solver) != nullptr);
}

} // namespace

BILLET_MPI_TEST(iterative_solvers) {
  std::ostringstream silence;
  std::streambuf *const console = std::cout.rdbuf();
  if (!testing::is_first_rank())
    std::cout.rdbuf(silence.rdbuf());
  // Fine enough for multigrid to have two levels.
  parameters::Scene billet = testing::read_shipped_scene("billet_upsetting.prm");
  billet.bodies[0].mesh.refinements = 2;
  billet.bodies[0].mesh.n_layers = 10;
  billet.time_stepping.end_time = 0.04;
  testing::set_fixed_steps(billet, 1);
  compare("billet, GMRES", billet, IterativeMethod::gmres);
  const bool is_alone = testing::n_ranks() == 1; // on several ranks, one scene for each method
  billet.pairs[0].friction = nullptr;
  if (is_alone)
    compare("frictionless billet, CG", billet, IterativeMethod::conjugate_gradients,
            2); // residuals next to the tolerance
  // The dofs in contact as a block.
  parameters::Scene blocks = parameters::Scene::read(std::string(SOURCE_DIR) + "/pressed_blocks.prm");
  if (is_alone)
    compare("two blocks, GMRES", blocks, IterativeMethod::gmres);
  blocks.pairs[0].friction = nullptr;
  blocks.solver.contact_tangent = parameters::ContactTangent::consistent; // for the direct solver, too
  // That tangent converges linearly, over some twenty iterations a step: round-off tells which is the last.
  compare("two blocks without friction, CG", blocks, IterativeMethod::conjugate_gradients, 3);
  std::cout.rdbuf(console); // `silence` goes first
}

} // namespace iterative_solvers_test
