// SPDX-License-Identifier: LGPL-2.1-or-later
// Usage: linear_solvers SOLVER DOFS K TIE [PRECONDITIONER]
//
// One linear system of two bodies in contact: see TwoBlocks. SOLVER: MUMPS, CG or GMRES; TIE: frictionless,
// sliding or sticking; PRECONDITIONER: plain multigrid; with the contact dofs as a block ('block'); and with
// softened contact, too
// ('softened', the default). Prints numbers that linear-solvers.py makes tables of.
#include "../solve/two_blocks.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>

#include <sys/resource.h>

#include <iostream>

using namespace dealii;
using billet::IterativeMethod;
using billet::IterativeSolver;
using billet::testing::TwoBlocks;

namespace {

struct Usage {
  double megabytes; ///< at most so far, of all ranks
  double seconds;   ///< of processors, of all ranks
};
Usage usage() {
  rusage own{};
  getrusage(RUSAGE_SELF, &own);
  const double seconds = static_cast<double>(own.ru_utime.tv_sec + own.ru_stime.tv_sec) +
                         1e-6 * static_cast<double>(own.ru_utime.tv_usec + own.ru_stime.tv_usec);
  return {Utilities::MPI::sum(static_cast<double>(own.ru_maxrss) / 1024., MPI_COMM_WORLD),
          Utilities::MPI::sum(seconds, MPI_COMM_WORLD)};
}

} // namespace

int main(int argc, char *argv[]) {
  const Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (argc < 5)
    return 2;
  const std::string name = argv[1], tie_name = argv[4], preconditioner = argc > 5 ? argv[5] : "softened";
  const double penalty = std::stod(argv[3]);
  const TwoBlocks::Tie tie = tie_name == "sticking"  ? TwoBlocks::Tie::sticking
                             : tie_name == "sliding" ? TwoBlocks::Tie::sliding
                                                     : TwoBlocks::Tie::frictionless;
  TwoBlocks blocks(MPI_COMM_WORLD, std::stod(argv[2]), true);
  const auto load = blocks.make_load();
  auto solution = load;
  const bool is_iterative = name == "CG" || name == "GMRES";
  blocks.assemble_cubes();
  if (!is_iterative)
    blocks.add_contact(penalty, tie);
  const double megabytes_before = usage().megabytes;

  std::unique_ptr<billet::LinearSolver> solver;
  if (is_iterative) {
    IterativeSolver::Settings settings;
    settings.method = name == "CG" ? IterativeMethod::conjugate_gradients : IterativeMethod::gmres;
    settings.max_iterations = 400;
    settings.solve_contact = preconditioner != "plain";
    if (preconditioner == "block")
      settings.contact_stiffness = 0.;
    auto iterative = std::make_unique<IterativeSolver>(settings, blocks.matrix(), MPI_COMM_WORLD);
    iterative->set_geometry(blocks.geometry());
    iterative->start_contact(blocks.contact_dofs());
    solver = std::move(iterative);
    blocks.add_contact(penalty, tie);
  } else
    solver = billet::make_direct_solver(
        tie == TwoBlocks::Tie::sliding ? billet::DirectMethod::mumps : billet::DirectMethod::mumps_symmetric,
        blocks.matrix(), MPI_COMM_WORLD);
  const double start = usage().seconds;
  bool success = solver->factorize();
  const double set_up = usage().seconds;
  success = success && solver->solve(load, solution, 1e-8);
  const Usage end = usage();

  auto residual = load;
  blocks.matrix().vmult(residual, solution);
  residual -= load;
  const double relative_residual = residual.l2_norm() / load.l2_norm();
  const unsigned int n_pairs = blocks.n_pairs();
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    std::cout << "dofs " << blocks.n_dofs() << " pairs " << n_pairs << " success " << success
              << " iterations " << solver->take_iterations() << " residual " << relative_residual
              << " set_up " << set_up - start << " solve " << end.seconds - set_up << " before "
              << megabytes_before << " peak " << end.megabytes << std::endl;
  return 0;
}
