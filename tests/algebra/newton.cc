// SPDX-License-Identifier: LGPL-2.1-or-later
// Newton's method on one equation: what the judge sees, how corrections are shortened, how exact linear
// solutions have to be, and how it ends.
#include "billet/algebra/newton.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>

#include <functional>
#include <limits>

namespace newton_test {

using namespace billet;
using billet::testing::check;

namespace {

/// R(x) = x² − 2, which is not admissible beyond `end`.
class Root final : public NonlinearSystem {
public:
  bool compute_residual(const Vector &x, Vector &residual) override {
    residual.begin()[0] = x.begin()[0] * x.begin()[0] - 2.;
    return x.begin()[0] <= end;
  }
  bool compute_tangent(const Vector &x) override {
    tangent_ = softening * 2. * x.begin()[0];
    return true;
  }
  bool solve_tangent(const Vector &residual, Vector &dx, const double relative_tolerance) override {
    tolerances.push_back(relative_tolerance);
    dx.begin()[0] = residual.begin()[0] / tangent_;
    return has_solution;
  }
  double max_step_length(const Vector &, const Vector &) override { return max_length; }
  double residual_scale() const override { return 1.; }

  double end = std::numeric_limits<double>::infinity(), softening = 1., max_length = 1.;
  bool has_solution = true;
  std::vector<double> tolerances;

private:
  double tangent_ = 0.;
};

struct Run {
  NewtonEnd end;
  double x;
  std::vector<double> lengths; ///< part of each correction that was taken
  bool is_judged_from_start = false;
  unsigned int n = 0;
};

Run run(Root &root, const double guess, const NewtonOptions &options, const unsigned int maximum = 20) {
  Vector x(dealii::complete_index_set(1), MPI_COMM_WORLD);
  x.begin()[0] = guess;
  Run result{};
  const auto judge = [&](const unsigned int n, const NewtonState &now, const NewtonCorrection *last) {
    if (last == nullptr)
      result.is_judged_from_start = n == 0 && now.x.begin()[0] == guess;
    else
      result.lengths.push_back((now.x.begin()[0] - last->from.x.begin()[0]) / last->full.begin()[0]);
    result.n = n;
    return now.norm <= options.residual_tolerance * now.scale ? NewtonVerdict::converged
           : n == maximum                                     ? NewtonVerdict::failed
                                                              : NewtonVerdict::unconverged;
  };
  result.end = solve_by_newton(root, options, judge, x);
  result.x = x.begin()[0];
  return result;
}

NewtonOptions make_options() {
  NewtonOptions options{};
  options.residual_tolerance = 1e-10;
  options.linear_tolerance = 1e-6;
  return options;
}

bool is_root(const double x) { return std::abs(x - std::sqrt(2.)) < 1e-9; }

} // namespace

BILLET_MPI_TEST(newton) {
  {
    Root root;
    const Run result = run(root, 1.5, make_options());
    check("it converges", result.end == NewtonEnd::converged && is_root(result.x));
    check("in quadratic convergence", result.n == 4 || result.n == 3);
    check("the judge sees the start", result.is_judged_from_start);
    bool are_whole = result.lengths.size() == result.n;
    for (const double length : result.lengths)
      are_whole = are_whole && std::abs(length - 1.) < 1e-6;
    check("and whole corrections", are_whole);
    bool are_constant = !root.tolerances.empty();
    for (std::size_t i = 0; i + 1 < root.tolerances.size(); ++i)
      are_constant = are_constant && root.tolerances[i] == 1e-6;
    check("linear solutions are as exact as asked for", are_constant);
  }
  {
    Root root;
    const Run result = run(root, 10., make_options(), 2);
    check("the judge ends it", result.end == NewtonEnd::failed && result.n == 2);
    check("and the last state is left", result.x < 10. && !is_root(result.x));
  }
  {
    Root root;
    root.end = 1.;
    check("a start that is not admissible",
          run(root, 1.5, make_options()).end == NewtonEnd::not_admissible_at_start);
    root.end = 1.45;
    const Run result = run(root, 1., make_options());
    check("corrections to what is not admissible are halved",
          result.end == NewtonEnd::converged && std::abs(result.lengths[0] - 0.5) < 1e-12);
  }
  {
    Root root;
    root.max_length = 0.25;
    const Run result = run(root, 10., make_options(), 1);
    check("corrections are as long as they may be", std::abs(result.lengths[0] - 0.25) < 1e-12);
    root.max_length = 0.;
    const Run none = run(root, 10., make_options());
    check("without any it fails", none.end == NewtonEnd::failed && none.n <= 1);
    root.max_length = 1.;
    root.has_solution = false;
    const Run singular = run(root, 10., make_options());
    check("so it does without a solution, and x stays",
          singular.end == NewtonEnd::failed && singular.x == 10. && singular.n == 0);
  }
  {
    NewtonOptions options = make_options();
    Root root;
    root.softening = 0.3; // overshoots
    const Run plain = run(root, 1.5, options, 1);
    options.searches_lines = true;
    const Run searched = run(root, 1.5, options);
    check("a correction that goes too far is shortened",
          std::abs(plain.lengths[0] - 1.) < 1e-12 && searched.lengths[0] < 0.9);
    check("and leads to the root", searched.end == NewtonEnd::converged && is_root(searched.x));
  }
  {
    NewtonOptions options = make_options();
    options.adapts_tolerance = true;
    Root root;
    run(root, 100., options);
    bool are_loose = root.tolerances.size() > 3 && root.tolerances[0] == options.max_linear_tolerance;
    for (const double tolerance : root.tolerances)
      are_loose = are_loose && tolerance >= options.linear_tolerance &&
                  tolerance <= std::max(options.max_linear_tolerance, 0.1);
    check("tolerances follow the iterations", are_loose && root.tolerances.back() < root.tolerances[0]);
  }
}

} // namespace newton_test
