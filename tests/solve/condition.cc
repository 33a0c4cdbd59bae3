// SPDX-License-Identifier: LGPL-2.1-or-later
// The condition of a matrix is found whatever right-hand sides it is solved with; its warning is printed
// once.
#include "../testing.h"
#include "billet/diagnostic_kinds.h"
#include "billet/solve/tangent_solver.h"

#include <deal.II/base/mpi.h>

namespace condition_test {

using namespace billet;
using billet::testing::check;

namespace {

/// Returns the number of warnings about a row of masses, each on a spring of 1, one that is `soft`, joined to
/// its neighbours by springs of a tenth; with a load that the soft one does not feel.
unsigned int times_reported(const double soft, const bool symmetric) {
  constexpr int n = 40, alone = 17;
  const dealii::IndexSet rows = dealii::complete_index_set(n);
  Matrix matrix(rows, MPI_COMM_WORLD, 3);
  Vector b(rows, MPI_COMM_WORLD), x(b);
  for (int row = 0; row < n; ++row) {
    const auto set = [&matrix, row](const int column, const double value) {
      matrix.set(static_cast<unsigned int>(row), static_cast<unsigned int>(column), value);
    };
    set(row, row == alone ? soft : 1.2);
    for (const int other : {row - 1, row + 1})
      if (other >= 0 && other < n)
        set(other, row == alone || other == alone ? 0. : -0.1);
    b(static_cast<unsigned int>(row)) = row == alone ? 0. : 1.;
  }
  matrix.compress(dealii::VectorOperation::insert);
  b.compress(dealii::VectorOperation::insert);
  parameters::Solver settings{};
  settings.linear_solver.value = symmetric ? DirectMethod::mumps_symmetric : DirectMethod::mumps;
  TangentSolver solver(settings, symmetric, matrix, MPI_COMM_WORLD);
  unsigned int n_reported = 0;
  for (unsigned int i = 0; i < 4; ++i) {
    check("it is solved", solver.factorize() && solver.solve(b, x, 1e-10));
    n_reported += find(solver.check_condition(), diagnostic::ill_conditioned) != nullptr ? 1 : 0;
  }
  return n_reported;
}

} // namespace

BILLET_MPI_TEST(condition) {
  for (const bool symmetric : {true, false}) {
    check("no warning is printed at a condition of 1e10", times_reported(1e-10, symmetric) == 0);
    check("one is printed, once, at 1e13", times_reported(1e-13, symmetric) == 1);
    check("and none at 10 with a stiff spring", times_reported(10., symmetric) == 0);
  }
}

} // namespace condition_test
