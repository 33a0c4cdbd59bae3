// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_DIRECT_SOLVER_H
#define BILLET_SOLVE_DIRECT_SOLVER_H

#include "billet/parameters/control.h"

#include <mpi.h>

#include <memory>
#include <string>

class Epetra_CrsMatrix;
class Epetra_Vector;

namespace billet {

/// A distributed sparse direct solver. The pattern is analysed once; a new factorisation reuses that.
class DirectSolver {
public:
  virtual ~DirectSolver() = default;

  /// Factorises the matrix as it is now. False, on all ranks, if it cannot be factorised; see failure().
  virtual bool factorize() = 0;

  /// Solves A x = b with the last factorisation. False, on all ranks, on failure.
  virtual bool solve(const Epetra_Vector &b, Epetra_Vector &x) = 0;

  virtual std::string name() const = 0;
  const std::string &failure() const { return failure_; }

protected:
  std::string failure_;
};

/// `matrix` must outlive the solver; its pattern may not change. `symmetric`: only its upper triangle is
/// used.
std::unique_ptr<DirectSolver> make_direct_solver(parameters::Solver::LinearSolver kind, bool symmetric,
                                                 const Epetra_CrsMatrix &matrix, MPI_Comm communicator);

} // namespace billet

#endif
