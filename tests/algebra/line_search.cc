// SPDX-License-Identifier: LGPL-2.1-or-later
// Limits of the line search and of linear solutions in Newton's method, each just beside its value: one
// equation, whose corrections have a length of 1.
#include "billet/algebra/newton.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace line_search_test {

using namespace billet;
using billet::testing::check;
using billet::testing::near;

namespace {

/// R(x) with the tangent |R(x)|: corrections go from x to x + 1 where R < 0.
class Equation final : public NonlinearSystem {
public:
  explicit Equation(std::function<double(double)> residual, const double end = 1e9)
      : residual_(std::move(residual)), end_(end) {}

  bool compute_residual(const Vector &x, Vector &residual) override {
    ++n_residuals;
    residual.begin()[0] = residual_(x.begin()[0]);
    return x.begin()[0] <= end_;
  }
  bool compute_tangent(const Vector &) override { return true; }
  bool solve_tangent(const Vector &residual, Vector &dx, const double relative_tolerance) override {
    tolerances.push_back(relative_tolerance);
    dx.begin()[0] = residual.begin()[0] > 0. ? 1. : -1.;
    return true;
  }
  double residual_scale() const override { return 1.; }

  unsigned int n_residuals = 0;
  std::vector<double> tolerances; ///< of the linear solutions

private:
  std::function<double(double)> residual_;
  double end_; ///< no larger x is admissible
};

NewtonOptions make_options() {
  NewtonOptions options{};
  options.residual_tolerance = 1e-10;
  options.linear_tolerance = 1e-6;
  options.searches_lines = true;
  return options;
}

/// Returns the lengths of so many corrections from x = 0; fewer if Newton's method fails before.
std::vector<double> lengths(Equation &equation, const unsigned int n_corrections,
                            const NewtonOptions &options = make_options()) {
  Vector x(dealii::complete_index_set(1), MPI_COMM_WORLD);
  std::vector<double> result;
  solve_by_newton(
      equation, options,
      [&](const unsigned int n, const NewtonState &now, const NewtonCorrection *last) {
        if (last != nullptr)
          result.push_back(now.x.begin()[0] - last->from.x.begin()[0]);
        return n == n_corrections ? NewtonVerdict::converged : NewtonVerdict::unconverged;
      },
      x);
  return result;
}

/// The length of the first correction, 0 without one, if R is -1 at its start and `end` at its end.
double first_length(const double end, const std::function<double(double)> &between) {
  Equation equation([&](const double x) { return x == 0. ? -1. : x == 1. ? end : between(x); });
  const std::vector<double> result = lengths(equation, 1);
  return result.empty() ? 0. : result[0];
}

void check_cuts() {
  const auto length_up_to = [](const double end) {
    Equation equation([](double) { return -1.; }, end);
    const std::vector<double> result = lengths(equation, 1);
    return result.empty() ? 0. : result[0];
  };
  check("corrections to what is not admissible are halved five times",
        length_up_to(1. / 31.) == 1. / 32. && length_up_to(1. / 33.) == 0.);
}

void check_trials() {
  const auto zero = [](double) { return 0.; };
  check("a correction is whole if the residual does no more work at its end",
        first_length(-0.99, zero) == 1. && first_length(-1.01, zero) < 1.);
  check("without a change of sign half of it is tried", first_length(-1.2, zero) == 0.5);
  check("else where the work would be zero", near(first_length(1.5, zero), 0.4, 1e-12));
  check("no closer to either end than a tenth", near(first_length(99., zero), 0.1, 1e-12));
  // The second trial finds the zero, at less than 0.4.
  const auto first_trial = [](const double work) {
    return [work](const double x) { return x > 0.39 ? work : 0.; };
  };
  check("a trial with 0.8 of the work is good enough",
        near(first_length(1.5, first_trial(0.79)), 0.4, 1e-12) &&
            first_length(1.5, first_trial(0.81)) < 0.39);
  Equation steep([](const double x) { return x == 0. ? -1. : 1. + x; });
  lengths(steep, 1);
  check("there are four trials", steep.n_residuals == 2 + 4);
}

/// Corrections before the first one that is shortened, if each leaves this part of the residual.
std::size_t n_whole(const double left) {
  Equation equation([left](const double x) { return x == std::floor(x) ? -std::pow(left, x) : 0.; });
  const std::vector<double> result = lengths(equation, 12);
  std::size_t n = 0;
  while (n < result.size() && result[n] == 1.)
    ++n;
  return n;
}

/// The length of the fifth correction, which leaves this part of a residual that has not changed before.
double fifth_length(const double left) {
  Equation equation([left](const double x) { return x < 4.1 ? -1. : x == 5. ? -left : 0.; });
  return lengths(equation, 5).at(4);
}

void check_stagnation() {
  const double just = std::cbrt(0.5); // of each correction, in three of them
  check("a residual stagnates if three corrections leave more than half of it",
        n_whole(just * 1.01) < 12 && n_whole(just * 0.99) == 12);
  check("which four residuals show", n_whole(0.95) == 4);
  check("then a correction has to leave less than 0.3 of the work",
        fifth_length(0.29) == 1. && fifth_length(0.31) == 0.5);
}

void check_linear_solutions() {
  // Residuals of 1, 0.2, 0.04, ...
  const auto tolerances = [](const NewtonOptions &options, const double size) {
    Equation equation([size](const double x) { return -size * std::pow(0.2, x); });
    lengths(equation, 2, options);
    return equation.tolerances;
  };
  NewtonOptions options = make_options();
  options.residual_tolerance = 1e-3;
  check("linear solutions are half as exact as the residual that ends the iterations",
        near(tolerances(options, 1.).at(0), 5e-4, 1e-12));
  check("but to a tenth of the present one", near(tolerances(options, 4.5e-3).at(0), 0.1, 1e-12) &&
                                                 near(tolerances(options, 5.5e-3).at(0), 1. / 11., 1e-12));
  options = make_options();
  options.adapts_tolerance = true;
  options.max_linear_tolerance = 0.09;
  check("tolerances that adapt are 0.9 times the square of the factor of the residual",
        near(tolerances(options, 1.).at(1), 0.9 * 0.2 * 0.2, 1e-12));
}

} // namespace

BILLET_MPI_TEST(line_search) {
  check_cuts();
  check_trials();
  check_stagnation();
  check_linear_solutions();
}

} // namespace line_search_test
