// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ALGEBRA_LINEAR_SOLVER_H
#define BILLET_ALGEBRA_LINEAR_SOLVER_H

#include "billet/algebra/matrix.h"
#include "billet/algebra/vector.h"

#include <string>

namespace billet {

/// Solver of A x = b for a distributed sparse matrix whose values change, but not its pattern. All
/// members are collective and return the same on all ranks.
class LinearSolver {
public:
  virtual ~LinearSolver() = default;

  /// Prepares solves with the present matrix. Returns false on failure; see failure().
  virtual bool factorize() = 0;

  /// Solves with the matrix of the last factorize(), so that |b − A x| <= relative_tolerance |b|. A
  /// direct solver ignores the tolerance. Returns false on failure.
  virtual bool solve(const Vector &b, Vector &x, double relative_tolerance) = 0;

  virtual std::string name() const = 0;
  /// Returns the number of iterations since the last call; 0 for a direct solver.
  virtual unsigned int take_iterations() { return 0; }
  /// Returns the memory of factors, or of the preconditioner, on all ranks [bytes]; 0 if it is
  /// unknown.
  virtual double memory() const { return 0.; }
  const std::string &failure() const { return failure_; }

protected:
  std::string failure_;
};

} // namespace billet

#endif
