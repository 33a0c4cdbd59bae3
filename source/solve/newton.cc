// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/newton.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <vector>

namespace billet {

namespace {

/// Limits of the iterations, beside NewtonLimits.
struct IterationLimits {
  /// Number of iterations to judge convergence by.
  static constexpr unsigned int window = 10;
  /// Maximum number of iterations to recover from round-off.
  static constexpr unsigned int max_in_round_off = 3;
  /// Increment below which it cannot normalise corrections, as part of the largest displacement; as
  /// in a scene at rest.
  static constexpr double min_increment = 1e-3;
  /// Residual over the last one above which the iterations stagnate.
  static constexpr double slow = 0.1;
  /// Part of the estimate of round-off that always applies: its last bit.
  static constexpr double certain = 0.01;
  /// Smallest of the last residuals over the smallest of those before, above which they stagnate.
  static constexpr double hardly_better = 0.7;
  /// Maximum number of iterations in a cycle.
  static constexpr std::size_t longest_cycle = 4;
  /// Maximum difference of residuals that are alike, and minimum difference of the smallest and the
  /// largest one of a cycle, as parts of them.
  static constexpr double alike = 0.02, apart = 0.2;
};

parameters::Solver tighten(parameters::Solver settings, const double accuracy) {
  settings.force_tolerance *= accuracy;
  settings.energy_tolerance *= accuracy;
  settings.displacement_tolerance *= accuracy;
  return settings;
}

/// Convergence test by the four criteria (Q1) and the limit on iterations, with a record of the
/// iterations.
class Convergence {
public:
  Convergence(const NonlinearProblem &problem, const parameters::Solver &settings, const double accuracy,
              const Vector &x_n, const bool accepts_stalled, NewtonReport &report)
      : problem_(problem), settings_(tighten(settings, accuracy)), x_n_(x_n),
        accepts_stalled_(accepts_stalled),
        describe_([settings, accuracy](const ConvergenceMeasures &measures) {
          return measures.describe(settings, accuracy);
        }),
        report_(report) {}

  /// See NewtonJudge.
  NewtonVerdict judge(const unsigned int n, const NewtonState &now, const NewtonCorrection *last) {
    const double norm = now.norm, scale = now.scale;
    const double residual_work = measure(now, last);
    const ConvergenceMeasures &measures = report_.measures;

    // Convergence is judged except for round-off of contact.
    const bool stagnates = n > 0 && norm > IterationLimits::slow * last_norm_;
    last_norm_ = norm;
    const auto is_small = [&](const double contact_round_off) {
      // The full round-off estimate applies only if the iterations stagnate.
      const double round_off =
          (stagnates ? 1. : IterationLimits::certain) * problem_.round_off_force() + contact_round_off;
      const bool is_exact = norm <= NewtonLimits::exact_residual * scale + round_off;
      const bool has_settled = measures.has_correction &&
                               measures.correction <= settings_.displacement_tolerance &&
                               measures.status <= settings_.force_tolerance;
      return norm <= settings_.force_tolerance * scale + round_off && (is_exact || has_settled) &&
             (n == 0 ||
              std::abs(residual_work) <= (settings_.energy_tolerance * scale + round_off) * increment_);
    };
    const double contact = problem_.contact_round_off_force(), cap = NewtonLimits::max_round_off * scale;
    const bool is_near = norm <= NewtonLimits::max_stalled_residual * scale;
    NewtonVerdict verdict = NewtonVerdict::unconverged;
    if (!std::isfinite(norm)) {
      report_.failure = "the residual is not a number";
      verdict = NewtonVerdict::failed;
    } else if (is_small(std::min(contact, cap))) {
      verdict = NewtonVerdict::converged;
    } else if (contact > cap && is_small(contact) && ++n_in_round_off_ > IterationLimits::max_in_round_off) {
      report_.is_stalled = is_near;
      report_.is_lost_in_round_off = !is_near;
      verdict = NewtonVerdict::converged;
    } else if (has_stalled(n) && is_near && measures.correction <= NewtonLimits::max_stalled_correction) {
      report_.is_stalled = true;
      verdict = accepts_stalled_ ? NewtonVerdict::converged : NewtonVerdict::failed;
      if (!accepts_stalled_)
        report_.failure = "after " + std::to_string(n) + " iterations the residual no longer falls";
    } else if (n >= settings_.max_iterations) {
      report_.failure = "Newton's method does not converge in " + std::to_string(n) + " iterations";
      verdict = NewtonVerdict::failed;
    } else if (n >= 3 * IterationLimits::window && has_stalled(n)) {
      // Later, drift is small beside the way so far.
      report_.failure =
          "the solver stops after " + std::to_string(n) + " iterations, since the residual no longer falls";
      verdict = NewtonVerdict::failed;
    } else if (is_hopeless(n) && !may_still_settle(n)) {
      report_.is_slow = true;
      report_.failure = "the solver stops after " + std::to_string(n) + " iterations, since at their rate " +
                        std::to_string(settings_.max_iterations) + " iterations are too few";
      verdict = NewtonVerdict::failed;
    }
    if (report_.is_stalled || verdict == NewtonVerdict::failed)
      report_.criteria = describe_(measures);
    if (verdict == NewtonVerdict::failed && std::isfinite(norm) && is_cycling(report_.iterations)) {
      report_.is_cycling = true;
      report_.failure = "after " + std::to_string(n) +
                        " iterations they cycle between the same states, and none is in equilibrium";
    }
    max_round_off_ = std::max(max_round_off_, contact); // nodes may just have opened
    if (verdict == NewtonVerdict::failed)
      report_.is_lost_in_round_off = !report_.is_stalled && max_round_off_ > cap &&
                                     norm <= NewtonLimits::near_round_off * max_round_off_;
    return verdict;
  }
  /// Whether an iteration has reached the round-off limit, above the permitted part of the forces.
  bool has_met_round_off() const { return n_in_round_off_ > 0; }

private:
  /// Returns a residual over the forces, or over those that round-off of displacements causes, if
  /// the forces are smaller. Then there are none to relate it to.
  double relative(const double norm, const double scale) const {
    const double reference = std::max(scale, problem_.round_off_force());
    return reference > 0. ? norm / reference : 0.;
  }
  /// Sets the report's measures, and appends the iteration that led here. Returns R · δu.
  double measure(const NewtonState &now, const NewtonCorrection *last) {
    const double norm = now.norm, scale = now.scale;
    ConvergenceMeasures &measures = report_.measures;
    measures = {};
    measures.force = report_.force = relative(norm, scale);
    Vector increment = now.x;
    increment -= x_n_;
    increment_ = increment.l2_norm();
    if (last == nullptr)
      return 0.;
    const NewtonState &before = last->from;
    Vector correction = now.x;
    correction -= before.x;
    const double residual_work = now.residual * correction;
    const double length = correction.l2_norm(), full_length = last->full.l2_norm();
    report_.iterations.push_back({relative(before.norm, before.scale), std::abs(before.residual * last->full),
                                  full_length > 0. ? length / full_length : 1.});
    // The full correction counts, even if it was shortened: the shortened length does not measure
    // the remaining distance.
    const double max_correction = last->full.linfty_norm();
    const double max_increment =
        std::max(increment.linfty_norm(), IterationLimits::min_increment * now.x.linfty_norm());
    measures.has_correction = true;
    measures.correction = max_increment > 0. ? max_correction / max_increment : 0.;
    measures.energy = scale * increment_ > 0. ? std::abs(residual_work) / (scale * increment_) : 0.;
    const StatusChanges changes = problem_.status_changes();
    measures.status = changes.part();
    measures.n_status_changes = changes.n;
    return residual_work;
  }
  /// Whether the residual no longer falls.
  bool has_stalled(const unsigned int n) const {
    const bool is_last = n >= settings_.max_iterations;
    return (n >= 2 * IterationLimits::window &&
            is_stagnant(report_.iterations, report_.force, IterationLimits::window)) ||
           (is_last && n >= IterationLimits::window &&
            is_stagnant(report_.iterations, report_.force, IterationLimits::window / 2));
  }
  /// Whether the residual has stalled, but is close to balance in some iterations.
  bool may_still_settle(const unsigned int n) const {
    if (n >= 3 * IterationLimits::window || !has_stalled(n))
      return false;
    for (unsigned int back = 1; back < IterationLimits::window; ++back)
      if (report_.iterations[n - back].force <= NewtonLimits::max_stalled_residual)
        return true;
    return false;
  }
  /// Whether, at the mean rate of the last iterations, the residual would miss its tolerance in the
  /// remaining ones.
  bool is_hopeless(const unsigned int n) const {
    constexpr unsigned int window = IterationLimits::window;
    if (n < 2 * window)
      return false;
    const double before = report_.iterations[n - window].force;
    const double to_go = std::log(report_.force / settings_.force_tolerance);
    const double pace = std::log(before / report_.force) / window; // per iteration
    return to_go > 0. && pace * (settings_.max_iterations - n) < to_go;
  }

  const NonlinearProblem &problem_;
  const parameters::Solver settings_; ///< with the tolerances that apply
  const Vector &x_n_;
  const bool accepts_stalled_;
  const std::function<std::string(const ConvergenceMeasures &)> describe_;
  NewtonReport &report_;
  double last_norm_ = 0., increment_ = 0.; // |Δu|
  unsigned int n_in_round_off_ = 0;
  double max_round_off_ = 0.;
};

} // namespace

std::string ConvergenceMeasures::describe(const parameters::Solver &tolerances, const double accuracy) const {
  std::ostringstream text;
  text.precision(2);
  const auto add_tolerance = [&](const double tolerance) {
    text << " (tolerance " << tolerance;
    if (accuracy != 1.)
      text << ", tightened to " << accuracy * tolerance;
    text << ")";
  };
  const auto add = [&](const char *what, const double value, const char *of_what, const double tolerance) {
    if (!(value > accuracy * tolerance))
      return;
    text << (text.tellp() > 0 ? ", " : "") << what << value << of_what;
    add_tolerance(tolerance);
  };
  text << "residual " << force << " of the forces";
  add_tolerance(tolerances.force_tolerance);
  if (!has_correction)
    return text.str();
  add("energy ", energy, " of the step's work", tolerances.energy_tolerance);
  add("correction ", correction, " of the step's increment", tolerances.displacement_tolerance);
  if (n_status_changes > 0.) {
    text << ", " << n_status_changes << (n_status_changes == 1. ? " change" : " changes")
         << " of contact status with " << status << " of the contact force";
    add_tolerance(tolerances.force_tolerance);
  }
  return text.str();
}

bool is_stagnant(const std::vector<NewtonIteration> &iterations, const double last_force,
                 const std::size_t window) {
  if (iterations.size() < 2 * window)
    return false;
  double before = std::numeric_limits<double>::infinity(), now = last_force;
  for (std::size_t i = 0; i < iterations.size(); ++i) {
    double &best = i + window <= iterations.size() ? before : now;
    best = std::min(best, iterations[i].force);
  }
  return now > IterationLimits::hardly_better * before;
}

bool is_cycling(const std::vector<NewtonIteration> &iterations) {
  constexpr std::size_t longest = IterationLimits::longest_cycle, window = 2 * longest;
  if (iterations.size() < window + longest)
    return false;
  const auto force = [&](const std::size_t back) { return iterations[iterations.size() - 1 - back].force; };
  for (std::size_t period = 2; period <= longest; ++period) {
    bool returns = true;
    double minimum = force(0), maximum = force(0);
    for (std::size_t back = 0; back < window; ++back) {
      returns =
          returns && std::abs(force(back) - force(back + period)) <= IterationLimits::alike * force(back);
      minimum = std::min(minimum, force(back));
      maximum = std::max(maximum, force(back));
    }
    if (returns && maximum - minimum > IterationLimits::apart * maximum)
      return true;
  }
  return false;
}

NewtonReport solve_newton(NonlinearProblem &problem, const parameters::Solver &settings, const Vector &x_n,
                          Vector &x, const bool accepts_stalled, const double accuracy) {
  NewtonReport report;
  NewtonOptions options{};
  options.residual_tolerance = accuracy * settings.force_tolerance;
  options.linear_tolerance = settings.linear_tolerance;
  options.adapts_tolerance = settings.forcing == parameters::Solver::Forcing::eisenstat_walker;
  options.searches_lines = settings.line_search == parameters::Solver::LineSearch::energy;
  Convergence convergence(problem, settings, accuracy, x_n, accepts_stalled, report);
  const NewtonEnd end = solve_by_newton(
      problem, options,
      [&convergence](const unsigned int n, const NewtonState &now, const NewtonCorrection *last) {
        return convergence.judge(n, now, last);
      },
      x);
  if (end == NewtonEnd::not_admissible_at_start) {
    report.failure = "the step's initial guess is not admissible (det F <= 0 or not a number)";
    return report;
  }
  report.converged = end == NewtonEnd::converged;
  report.hardest = report.iterations.size();
  report.is_lost_in_round_off =
      report.is_lost_in_round_off || (!report.converged && convergence.has_met_round_off());
  if (!report.converged && report.failure.empty())
    report.failure =
        "the correction leads to inadmissible states (det F <= 0 or not a number), or the matrix is singular";
  return report;
}

} // namespace billet
