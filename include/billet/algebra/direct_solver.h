// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ALGEBRA_DIRECT_SOLVER_H
#define BILLET_ALGEBRA_DIRECT_SOLVER_H

#include "billet/algebra/linear_method.h"
#include "billet/algebra/linear_solver.h"

#include <mpi.h>

#include <memory>

namespace billet {

/// Makes a distributed sparse direct solver. The pattern is analysed once; later factorisations
/// reuse the analysis. `matrix` must outlive the solver. Throws InputError if Trilinos was built
/// without the method.
std::unique_ptr<LinearSolver> make_direct_solver(DirectMethod method, const Matrix &matrix,
                                                 MPI_Comm communicator);

} // namespace billet

#endif
