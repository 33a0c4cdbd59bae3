// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_ERROR_BUDGET_H
#define BILLET_SOLVE_ERROR_BUDGET_H

#include <algorithm>
#include <cmath>

namespace billet {

/// Parts of a target error, and limits of the measurements that keep it; "Target error" in
/// doc/theory.md.
struct ErrorBudget {
  /// Part of the target for penetration. 0.4 of it is for steps, by the presets of a target; the
  /// rest is a margin for poor estimates.
  static constexpr double penetration = 0.3;
  /// The same part if steps cause no error.
  static constexpr double penetration_alone = 0.5;
  /// Residual of steps that are compared: over the square of the target, and its maximum over the
  /// target.
  static constexpr double residual_over_square = 10., max_residual = 0.1;
  /// Maximum difference between the lengths of two steps that are compared with one, as part of the
  /// first.
  static constexpr double max_difference = 0.01;
  /// Number of remaining steps from which on the target counts as expensive.
  static constexpr double very_many = 2000.;

  /// Returns the allowed error by penetration, as part of the forces.
  static double of_penetration(const double target, const bool depends_on_steps) {
    return depends_on_steps ? penetration * target : penetration_alone * target;
  }
  /// Returns the residual of steps that are compared, as part of the forces. Their difference,
  /// which falls with the square of the target, must exceed it.
  static double residual(const double target) {
    return std::min(max_residual, residual_over_square * target) * target;
  }
  /// Whether two successive steps can be compared with one of twice the length of the first.
  static bool are_equal(const double first, const double second) {
    return std::abs(second - first) <= max_difference * first;
  }
  static bool is_expensive(const double remaining_steps) { return !(remaining_steps < very_many); }
};

} // namespace billet

#endif
