// SPDX-License-Identifier: LGPL-2.1-or-later
// The condition of a matrix is found whatever right-hand sides it is solved with, and told once.
#include "../testing.h"
#include "billet/diagnostic_kinds.h"
#include "billet/solve/tangent_solver.h"

#include <deal.II/base/mpi.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>

using namespace billet;
using billet::testing::check;

namespace {

/// How often it is told of a row of masses, each on a spring of 1, one that is `soft`, and joined to its
/// neighbours by springs of a tenth; with a load that the soft one does not feel.
unsigned int times_told(const double soft, const bool symmetric) {
  constexpr int n = 40, alone = 17;
  const Epetra_MpiComm communicator(MPI_COMM_WORLD);
  const Epetra_Map map(n, 0, communicator);
  Epetra_CrsMatrix matrix(Copy, map, 3);
  Epetra_Vector b(map), x(map);
  for (int i = 0; i < map.NumMyElements(); ++i) {
    const int row = map.GID(i);
    double diagonal = row == alone ? soft : 1.2;
    matrix.InsertGlobalValues(row, 1, &diagonal, &row);
    for (const int other : {row - 1, row + 1}) {
      double value = row == alone || other == alone ? 0. : -0.1;
      if (other >= 0 && other < n)
        matrix.InsertGlobalValues(row, 1, &value, &other);
    }
    b[i] = row == alone ? 0. : 1.;
  }
  matrix.FillComplete();
  parameters::Solver settings{};
  settings.linear_solver.value =
      symmetric ? parameters::Solver::LinearSolver::mumps_symmetric : parameters::Solver::LinearSolver::mumps;
  TangentSolver solver(settings, symmetric, matrix, MPI_COMM_WORLD);
  unsigned int n_told = 0;
  for (unsigned int i = 0; i < 4; ++i) {
    check("it is solved", solver.factorize() && solver.solve(b, x, 1e-10));
    n_told += find(solver.check_condition(), diagnostic::ill_conditioned) != nullptr ? 1 : 0;
  }
  return n_told;
}

} // namespace

int main(int argc, char *argv[]) {
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const bool symmetric : {true, false}) {
    check("a condition of 1e10 is not told", times_told(1e-10, symmetric) == 0);
    check("one of 1e13 is, once", times_told(1e-13, symmetric) == 1);
    check("nor is one of 10 with a stiff one", times_told(10., symmetric) == 0);
  }
  return testing::exit_code();
}
