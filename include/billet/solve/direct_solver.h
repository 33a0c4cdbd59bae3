// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_DIRECT_SOLVER_H
#define BILLET_SOLVE_DIRECT_SOLVER_H

#include "billet/parameters/control.h"
#include "billet/solve/linear_solver.h"

#include <mpi.h>

#include <memory>

namespace billet {

/// A distributed sparse direct solver. The pattern is analysed once; a new factorisation reuses that.
/// `symmetric`: only the matrix's upper triangle is used. Iterative kinds count as automatic.
std::unique_ptr<LinearSolver> make_direct_solver(parameters::Solver::LinearSolver kind, bool symmetric,
                                                 const Epetra_CrsMatrix &matrix, MPI_Comm communicator);

} // namespace billet

#endif
