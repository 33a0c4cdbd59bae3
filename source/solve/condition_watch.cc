// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/condition_watch.h"

#include "billet/diagnostic_kinds.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>

namespace billet {

void ConditionWatch::start(const Matrix &matrix, LinearSolver &solver) {
  norm_ = is_ill_conditioned_ ? 0. : matrix.linfty_norm();
  condition_ = 0.;
  ++n_factorized_;
  if ((n_factorized_ & (n_factorized_ - 1)) == 0) // at the 1st, 2nd, 4th, ...
    estimate(matrix, solver);
}

void ConditionWatch::estimate(const Matrix &matrix, LinearSolver &solver) {
  if (is_ill_conditioned_)
    return;
  // Inverse iteration: the second solution is nearly along the direction that A^-1 amplifies most.
  constexpr unsigned int n_solutions = 2;
  const dealii::IndexSet owned = matrix.locally_owned_range_indices();
  Vector b(owned, matrix.get_mpi_communicator()), x(b);
  for (std::size_t i = 0; i < owned.n_elements(); ++i) {
    // The values oscillate in the same way on any number of ranks.
    const auto row = static_cast<std::uint64_t>(owned.nth_index_in_set(i)) + 1;
    b.begin()[i] = ((row * 0x9e3779b97f4a7c15ULL) >> 63) == 0 ? 1. : -1.;
  }
  for (unsigned int n = 0; n < n_solutions; ++n) {
    const double of_b = b.l2_norm();
    if (!(of_b > 0.) || !std::isfinite(of_b))
      return;
    b *= 1. / of_b;
    if (!solver.solve(b, x, 1.))
      return;
    update(b, x);
    b = x;
  }
}

void ConditionWatch::update(const Vector &b, const Vector &x) {
  if (is_ill_conditioned_)
    return;
  const double of_b = b.l2_norm(), of_x = x.l2_norm();
  if (of_b > 0.)
    condition_ = std::max(condition_, norm_ * of_x / of_b);
}

DiagnosticList ConditionWatch::check() {
  constexpr double maximum = 1e12; // four digits are left
  if (is_ill_conditioned_ || !(condition_ > maximum))
    return {};
  std::ostringstream text;
  text.precision(1);
  text << "The condition of the matrix is " << std::scientific << condition_
       << " or more: few of the sixteen digits of a correction are right";
  is_ill_conditioned_ = true;
  return {Diagnostic(diagnostic::ill_conditioned, text.str()).measure("condition", condition_)};
}

} // namespace billet
