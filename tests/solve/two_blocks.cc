// SPDX-License-Identifier: LGPL-2.1-or-later
// Two bodies tied by contact penalties: every linear solver finds the direct one's solution, iterative ones
// say the true residual, in iterations that do not depend on the penalty, and say when they fail; other
// patterns are taken over.
#include "two_blocks.h"

#include "billet/diagnostic_kinds.h"
#include "billet/solve/tangent_solver.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>

#include <sstream>
#include <vector>

namespace two_blocks_test {

using namespace billet;
using billet::testing::check;
using billet::testing::TwoBlocks;
using Kind = std::optional<LinearMethod>;

namespace {

double distance(const Vector &a, const Vector &b) {
  Vector difference = a;
  difference -= b;
  return difference.l2_norm() / b.l2_norm();
}

bool solve(LinearSolver &solver, const Vector &b, Vector &x, const double tolerance) {
  return solver.factorize() && solver.solve(b, x, tolerance);
}

double true_residual(const TwoBlocks &blocks, const Vector &x, const Vector &b) {
  Vector product = b;
  blocks.matrix().vmult(product, x);
  return distance(product, b);
}

struct Outcome {
  bool success;
  unsigned int iterations;
};

/// One solve of the blocks at this penalty, compared with `exact`.
Outcome solve_and_check(const std::string &name, TwoBlocks &blocks, const double penalty,
                        const TwoBlocks::Tie tie, const IterativeSolver::Settings &settings,
                        const Vector &load, const Vector &exact) {
  IterativeSolver solver(settings, blocks.matrix(), MPI_COMM_WORLD);
  solver.set_geometry(blocks.geometry());
  blocks.assemble_cubes();
  solver.start_contact(blocks.contact_dofs());
  blocks.add_contact(penalty, tie);
  Vector solution = load;
  constexpr double tolerance = 1e-10;
  const bool success = solve(solver, load, solution, tolerance);
  if (success) {
    check(name + ": the direct solver's solution", distance(solution, exact), 1e-7);
    check(name + ": the residual asked for", true_residual(blocks, solution, load), tolerance);
    check(name + ": it says how much memory it takes",
          solver.memory() > 8. * 6. * static_cast<double>(blocks.n_dofs()));
  }
  return {success, solver.take_iterations()};
}

} // namespace

BILLET_MPI_TEST(two_blocks) {
  std::ostringstream silence;
  std::streambuf *const console = std::cout.rdbuf();
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    std::cout.rdbuf(silence.rdbuf());

  // What depends on the penalty does so on any number of ranks.
  const bool is_alone = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1;
  TwoBlocks blocks(MPI_COMM_WORLD, 4000., false);
  const Vector load = blocks.make_load();
  Vector exact = load, solution = load;
  using Tie = TwoBlocks::Tie;
  for (const Tie tie : {Tie::sticking, Tie::frictionless, Tie::sliding})
    for (const double penalty : is_alone ? std::vector<double>{1., 1e4} : std::vector<double>{1e4}) {
      if (tie == Tie::frictionless && !is_alone)
        continue;
      std::ostringstream name;
      name << (tie == Tie::sticking  ? "sticking"
               : tie == Tie::sliding ? "sliding"
                                     : "frictionless")
           << ", k " << penalty;
      blocks.assemble_cubes();
      blocks.add_contact(penalty, tie);
      const auto direct =
          make_direct_solver(tie == Tie::sliding ? DirectMethod::mumps : DirectMethod::mumps_symmetric,
                             blocks.matrix(), MPI_COMM_WORLD);
      const bool is_solved = solve(*direct, load, exact, 0.);
      const double round_off = 1e-14 * blocks.matrix().linfty_norm() * exact.l2_norm() / load.l2_norm();
      check(name.str() + ": directly, to round-off",
            is_solved && true_residual(blocks, exact, load) < round_off);

      IterativeSolver::Settings settings;
      const auto by_gmres =
          solve_and_check(name.str() + ", GMRES", blocks, penalty, tie, settings, load, exact);
      check(name.str() + ", GMRES: at most 45 iterations", by_gmres.success && by_gmres.iterations <= 45);
      if (tie == Tie::sliding)
        continue;
      settings.method = IterativeMethod::conjugate_gradients;
      const auto by_cg = solve_and_check(name.str() + ", CG", blocks, penalty, tie, settings, load, exact);
      check(name.str() + ", CG: at most 45 iterations", by_cg.success && by_cg.iterations <= 45);
      if (penalty < 1e4 || !is_alone)
        continue;
      settings.solve_contact = false;
      settings.max_iterations = 3 * by_cg.iterations;
      const auto plain =
          solve_and_check(name.str() + ", multigrid alone", blocks, penalty, tie, settings, load, exact);
      check(name.str() + ": multigrid alone needs three times as many, at least", !plain.success);
    }

  {
    IterativeSolver::Settings settings;
    settings.max_iterations = 2;
    const auto outcome =
        solve_and_check("two iterations", blocks, 1., Tie::frictionless, settings, load, exact);
    check("two iterations: do not do", !outcome.success && outcome.iterations == 2);
  }

  { // A hierarchy outlives its matrix as long as it serves.
    IterativeSolver::Settings settings;
    settings.max_iterations = 1000;
    IterativeSolver solver(settings, blocks.matrix(), MPI_COMM_WORLD);
    solver.set_geometry(blocks.geometry());
    const auto solves = [&](const double penalty, const bool with_block) {
      blocks.assemble_cubes();
      if (with_block)
        solver.start_contact(blocks.contact_dofs());
      blocks.add_contact(penalty, Tie::frictionless);
      return solve(solver, load, solution, 1e-10) && true_residual(blocks, solution, load) < 1.1e-10;
    };
    check("hierarchy: the first", solves(1., true) && solver.n_hierarchies() == 1);
    check("hierarchy: kept", solves(1.5, true) && solves(1e4, true) && solver.n_hierarchies() == 1);
    check("hierarchy: replaced where it does not serve", solves(100., false) && solver.n_hierarchies() == 2);
  }

  // A scene's solver, and another matrix in the middle.
  TwoBlocks others(MPI_COMM_WORLD, 5500., true);
  const Vector other_load = others.make_load();
  Vector other_exact = other_load;
  others.assemble_cubes();
  others.add_contact(10., Tie::sticking);
  {
    const auto direct = make_direct_solver(DirectMethod::mumps_symmetric, others.matrix(), MPI_COMM_WORLD);
    check("another matrix: directly", solve(*direct, other_load, other_exact, 0.));
  }
  blocks.assemble_cubes();
  blocks.add_contact(1., Tie::frictionless);
  {
    const auto direct = make_direct_solver(DirectMethod::mumps_symmetric, blocks.matrix(), MPI_COMM_WORLD);
    check("the first matrix: directly", solve(*direct, load, exact, 0.));
  }
  for (const Kind kind : {Kind(), Kind(DirectMethod::mumps), Kind(DirectMethod::mumps_symmetric),
                          Kind(IterativeMethod::conjugate_gradients), Kind(IterativeMethod::gmres)})
    for (const unsigned int max_iterations : {200u, 1u}) {
      const bool is_iterative = kind && std::holds_alternative<IterativeMethod>(*kind);
      if (!is_iterative && max_iterations == 1)
        continue;
      parameters::Solver settings{};
      settings.linear_solver.value = kind;
      settings.max_linear_iterations = max_iterations;
      TangentSolver solver(settings, true, blocks.matrix(), MPI_COMM_WORLD);
      const std::string name = solver.name() + ", at most " + std::to_string(max_iterations) + " iterations";
      check(name + ": of its kind", solver.is_iterative() == is_iterative);
      const auto solve_it = [&](const TwoBlocks &system, const Vector &b, const Vector &reference) {
        Vector x = b;
        if (is_iterative) {
          solver.set_geometry(system.geometry());
          solver.start_contact({});
        }
        check(name + ": solves", solver.factorize() && solver.solve(b, x, 1e-10));
        check(name + ": the solution", distance(x, reference), 1e-7);
      };
      for (unsigned int i = 0; i < (max_iterations == 1 ? 3 : 2); ++i)
        solve_it(blocks, load, exact);
      const unsigned int iterations = solver.take_iterations();
      // The first and the second matrix are tried iteratively, then one is left out.
      check(name + ": iterations", !is_iterative         ? iterations == 0
                                   : max_iterations == 1 ? iterations == 2
                                                         : iterations > 20);
      solver.release();
      solver.set_matrix(others.matrix());
      solve_it(others, other_load, other_exact);
      const billet::DiagnosticList messages = solver.take_diagnostics();
      check(name + ": reports its memory",
            (find(messages, billet::diagnostic::solver_memory) != nullptr) == is_iterative);
      check(name + ": reports that it failed",
            (find(messages, billet::diagnostic::direct_solver) != nullptr) == (max_iterations == 1));
      check(name + ": has reported", solver.take_diagnostics().empty() && solver.take_iterations() < 200);
    }
  std::cout.rdbuf(console); // `silence` goes first
}

} // namespace two_blocks_test
