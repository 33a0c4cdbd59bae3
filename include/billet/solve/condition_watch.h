// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_CONDITION_WATCH_H
#define BILLET_SOLVE_CONDITION_WATCH_H

#include "billet/algebra/linear_solver.h"
#include "billet/diagnostics.h"

namespace billet {

/// Lower bound on the condition of the matrix that a direct solver factorised last.
class ConditionWatch {
public:
  /// Starts with a matrix just factorised, at times with estimate(). Collective.
  void start(const Matrix &matrix, LinearSolver &solver);
  /// Updates the condition by |A| |x|/|b|, without additional cost.
  void update(const Vector &b, const Vector &x);
  /// Returns a warning if the matrix is ill-conditioned; once.
  DiagnosticList check();

private:
  /// Estimates the condition by two solves.
  void estimate(const Matrix &matrix, LinearSolver &solver);

  bool is_ill_conditioned_ = false; ///< and reported
  unsigned int n_factorized_ = 0;
  double norm_ = 0.; ///< |A|
  double condition_ = 0.;
};

} // namespace billet

#endif
