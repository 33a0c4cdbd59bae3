// SPDX-License-Identifier: LGPL-2.1-or-later
// Parts of a target error, and limits of the measurements that keep it.
#include "billet/solve/error_budget.h"

#include "../testing.h"

#include <limits>

namespace error_budget_test {

using billet::ErrorBudget;
using billet::testing::check;
using billet::testing::near;

BILLET_TEST(error_budget) {
  constexpr double rounding = 1e-14;
  check("of a target of 1 % penetration may cause 0.3 % beside steps",
        near(ErrorBudget::of_penetration(0.01, true), 3e-3, rounding));
  check("and half of it where steps cause no error",
        near(ErrorBudget::of_penetration(0.01, false), 5e-3, rounding));
  check("residuals are ten times the square of the target",
        near(ErrorBudget::residual(1e-3), 1e-5, rounding) &&
            near(ErrorBudget::residual(1e-4), 1e-7, rounding));
  check("but at most a tenth of it", near(ErrorBudget::residual(0.05), 5e-3, rounding));
  check("steps are compared if they differ by less than 1 %",
        ErrorBudget::are_equal(2., 2.0198) && ErrorBudget::are_equal(2., 1.9802));
  check("and by no more", !ErrorBudget::are_equal(2., 2.0202) && !ErrorBudget::are_equal(2., 1.9798));
  check("nor if a length is unknown", !ErrorBudget::are_equal(2., std::numeric_limits<double>::quiet_NaN()));
  check("2000 remaining steps are expensive, fewer are not",
        ErrorBudget::is_expensive(2000.) && !ErrorBudget::is_expensive(1990.));
}

} // namespace error_budget_test
