// SPDX-License-Identifier: LGPL-2.1-or-later
// When Newton's method ends, of small problems whose iterations are known: each of the four criteria by
// itself, residuals that stall, and what is said of those that fail.
#include "billet/solve/newton.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>

#include <functional>

namespace convergence_test {

using namespace billet;
using billet::testing::check;
using billet::testing::near;

namespace {

/// Independent equations R_i(x_i) = 0.
class Springs final : public NonlinearProblem {
public:
  struct Spring {
    std::function<double(double)> residual, tangent;
  };
  explicit Springs(std::vector<Spring> springs) : springs_(std::move(springs)) {}

  bool compute_residual(const Vector &x, Vector &residual) override {
    for (std::size_t i = 0; i < springs_.size(); ++i)
      residual.begin()[i] = springs_[i].residual(x.begin()[i]);
    return true;
  }
  bool compute_tangent(const Vector &x) override {
    ++n_tangents;
    x_ = x;
    return true;
  }
  bool solve_tangent(const Vector &residual, Vector &dx, double) override {
    for (std::size_t i = 0; i < springs_.size(); ++i)
      dx.begin()[i] = residual.begin()[i] / springs_[i].tangent(x_.begin()[i]);
    return true;
  }
  double force_scale() const override { return scale; }
  double round_off_force() const override { return round_off; }
  double contact_round_off_force() const override { return contact_round_off; }
  StatusChanges status_changes() const override {
    return n_tangents <= n_changing ? StatusChanges{2., 0.1, 1.} : StatusChanges{};
  }

  unsigned int n_tangents = 0, n_changing = 0;
  double round_off = 0., contact_round_off = 0., scale = 1.;

private:
  std::vector<Spring> springs_;
  Vector x_;
};

parameters::Solver make_settings() {
  parameters::Solver settings{};
  settings.force_tolerance = 5e-3;
  settings.energy_tolerance = 5e-5;
  settings.displacement_tolerance = 1e-2;
  settings.max_iterations = 60;
  settings.line_search = parameters::Solver::LineSearch::none;
  settings.forcing = parameters::Solver::Forcing::fixed;
  settings.linear_tolerance = 1e-6;
  return settings;
}

struct Result {
  NewtonReport report;
  std::vector<double> x;
};

/// `start`: x_n.
Result solve(Springs &springs, const std::vector<double> &guess,
             const parameters::Solver &settings = make_settings(), const bool accepts_stalled = true,
             const double start = 0., const double accuracy = 1.) {
  Vector x_n(dealii::complete_index_set(guess.size()), MPI_COMM_WORLD);
  x_n = start;
  Vector x = x_n;
  std::copy(guess.begin(), guess.end(), x.begin());
  Result result;
  result.report = solve_newton(springs, settings, x_n, x, accepts_stalled, accuracy);
  result.x.assign(x.begin(), x.end());
  return result;
}

/// k (x − 1).
Springs::Spring linear(const double k) {
  return {[k](const double x) { return k * (x - 1.); }, [k](double) { return k; }};
}
/// The same with a tangent that is too stiff: each iteration leaves this part of the residual.
Springs::Spring slow(const double k, const double left) {
  return {[k](const double x) { return k * (x - 1.); }, [k, left](double) { return k / (1. - left); }};
}
/// The same with friction that turns about with the motion: |R| is never below `jump`. Newton's method ends
/// up on the one side and the other, with 2 jump.
Springs::Spring chattering(const double jump, const double k = 1.) {
  return {[jump, k](const double x) { return k * (x - 1.) + (x < 1. ? -jump : jump); },
          [k](double) { return k; }};
}

} // namespace

BILLET_MPI_TEST(convergence) {
  {
    Springs springs({linear(1.)});
    const Result result = solve(springs, {0.5});
    check("a residual of nothing needs no second iteration",
          result.report.converged && result.report.iterations.size() == 1);
  }
  {
    Springs springs({linear(1.)});
    const Result result = solve(springs, {0.997});
    check("a first guess within the force tolerance is not enough",
          result.report.converged && result.report.iterations.size() == 1 && near(result.x[0], 1., 1e-9));
  }
  {
    // A soft spring beside a force of 1: the residual is small from the start.
    Springs springs({slow(4e-3, 0.3)});
    const Result result = solve(springs, {0.});
    const double last = result.report.measures.correction;
    check("a correction of more than 1 % goes on", result.report.converged && last <= 1e-2 && last > 3e-3 &&
                                                       result.report.iterations.size() == 5 &&
                                                       result.report.iterations[0].force < 5e-3);
    check("what is left of the displacement is that small", near(result.x[0], 1., 1e-2));
  }
  {
    Springs springs({slow(1., 0.05)});
    springs.n_changing = 5;
    const Result result = solve(springs, {0.});
    check("changes of contact status go on until the residual is exact",
          result.report.converged && result.report.iterations.size() == 5);
    Springs changing({slow(1., 0.05)});
    changing.n_changing = 2;
    const Result once = solve(changing, {0.});
    check("without them it is over earlier", once.report.converged && once.report.iterations.size() == 3);
  }
  {
    Springs springs({chattering(0.008)});
    const Result result = solve(springs, {0.});
    check("a residual that stalls at 1.6 % is accepted",
          result.report.converged && result.report.is_stalled && near(result.report.force, 0.016, 1e-9));
    check("and said with its value",
          result.report.criteria.find("residual 0.016 of the forces (tolerance 0.005)") == 0);
    Springs tightened({chattering(0.0015)});
    check("where augmentation tightens the tolerance, with both",
          solve(tightened, {0.}, make_settings(), true, 0., 0.1)
                  .report.criteria.find(
                      "residual 0.003 of the forces (tolerance 0.005, tightened to 0.0005)") == 0);
    Springs again({chattering(0.008)});
    const Result refused = solve(again, {0.}, make_settings(), false);
    check("unless something else may help", !refused.report.converged && refused.report.is_stalled);
    Springs within_a_digit({chattering(0.6e-6)});
    parameters::Solver tight = make_settings();
    tight.force_tolerance = 1e-6;
    const Result near_by = solve(within_a_digit, {0.}, tight);
    check("1.2e-6 for a tolerance of 1e-6 is accepted",
          near_by.report.converged && near_by.report.is_stalled);
  }
  {
    Springs springs({chattering(0.1)});
    const Result result = solve(springs, {0.});
    check("at 20 % it is not", !result.report.converged && !result.report.is_stalled);
    check("and the criterion is named",
          result.report.criteria.find("residual 0.2 of the forces (tolerance 0.005)") == 0 &&
              result.report.criteria.find("energy") != std::string::npos &&
              result.report.criteria.find("of the step's increment") != std::string::npos);
  }
  {
    Springs springs({chattering(0.008), linear(1.)});
    springs.n_changing = 1000;
    const Result result = solve(springs, {0., 0.});
    check("so are the nodes that chatter",
          result.report.is_stalled &&
              result.report.criteria.find(
                  "2 changes of contact status with 0.1 of the contact force (tolerance 0.005)") !=
                  std::string::npos);
  }
  {
    // What is not held drifts on at a small residual.
    for (const double residual : {1e-2, 4e-3}) {
      Springs springs({{[residual](double) { return residual; }, [](double) { return -1e-3; }}});
      const Result result = solve(springs, {0.});
      check("a residual that stalls where corrections do not is not accepted",
            !result.report.converged && !result.report.is_stalled && result.report.iterations.size() == 30);
    }
  }
  {
    Springs free({linear(1.)});
    free.scale = 1e-4;
    free.round_off = 0.1;
    const Result result = solve(free, {1. - 5e-5});
    check("where there are no forces, residuals are parts of those by round-off",
          result.report.converged && near(result.report.force, 5e-4, 1e-9));
  }
  {
    Springs springs({slow(1., 0.9)});
    parameters::Solver settings = make_settings();
    settings.force_tolerance = 1e-8;
    const Result result = solve(springs, {0.}, settings);
    check("slow convergence is no stall", !result.report.converged && !result.report.is_stalled);
  }
  {
    Springs springs({chattering(1e-3)});
    springs.contact_round_off = 2e-3;
    const Result result = solve(springs, {0.});
    check("what round-off leaves is no stall", result.report.converged && !result.report.is_stalled);
    Springs coarse({chattering(8e-3)});
    coarse.contact_round_off = 0.02;
    const Result lost = solve(coarse, {0.});
    check("above its limit it is",
          lost.report.converged && lost.report.is_stalled && !lost.report.is_lost_in_round_off);
    Springs noise({chattering(0.05)});
    noise.contact_round_off = 0.2;
    check("and above 2 % it is lost", solve(noise, {0.}).report.is_lost_in_round_off);
  }
  {
    StatusChanges changes;
    const auto force = [](const double f) { return dealii::Tensor<1, 3>({f, 0., 0.}); };
    changes.add({{ContactStatus::stick, force(3.)}, {ContactStatus::slip, force(2.)}, {}, {}},
                {{ContactStatus::stick, force(4.)},
                 {ContactStatus::stick, force(1.)},
                 {ContactStatus::slip, force(5.)},
                 {}});
    check("of two nodes that change the forces change by 6 of 10",
          changes.n == 2. && near(changes.part(), 0.6, 1e-12));
    StatusChanges release;
    release.add({{ContactStatus::stick, force(3.)}}, {{}});
    check("where all let go it is all", release.part() == 1.);
    check("without contact nothing", StatusChanges().part() == 0.);
  }
}

} // namespace convergence_test
