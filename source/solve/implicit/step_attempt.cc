// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/step_attempt.h"

#include <algorithm>

namespace billet {

namespace {

/// Limits of iterations that balance bodies, see ResultantGuard.
struct StepAttemptLimits {
  /// Maximum number of refinements in a step.
  static constexpr unsigned int max_refinements = 2;
  /// Part of what may be out of balance that a refinement aims at, and the minimum factor of its
  /// tolerance.
  static constexpr double aim = 0.5, min_factor = 1e-3;
};

} // namespace

void StepAttempt::begin(const double t) {
  ImplicitProblem &problem = p_.problem;
  ImplicitParts &parts = problem.parts();
  problem.step().time = t;
  p_.measurement.begin();
  parts.tools().clear_failure();
  problem.clear_obstacle();
  parts.tools().restart();
  std::vector<std::size_t> pressing;
  const auto &tools = parts.scene().tools();
  for (std::size_t i = 0; i < tools.size(); ++i)
    if (tools[i].is_driven() && !parts.removal().is_removed(i))
      pressing.push_back(i);
  parts.tools().choose_unknown(pressing);
  parts.stabilisation().start_step(t - problem.state().time);
  stopping_.clear();
  p_.rules.begin_attempt();
}

bool StepAttempt::find_guess(const double t, const double previous_step, NewtonIteration &linear_step,
                             NewtonReport &report) {
  ImplicitProblem &problem = p_.problem;
  ImplicitParts &parts = problem.parts();
  Predictor &predictor = p_.rules.predictor();
  bool has_guess = predictor.guess(t, previous_step), takes_solution = !has_guess;
  parts.scheme().start_step(problem.state().time, t, problem.step().start.displacements,
                            parts.tools().start_offsets());
  if (takes_solution)
    has_guess = predictor.follow_tangent(t, linear_step);
  problem.start_step(t);
  if (has_guess && !takes_solution && predictor.has_alternative() && p_.guards.paths.judge_path(false)) {
    has_guess = predictor.follow_tangent(t, linear_step);
    problem.start_step(t);
  }
  if (has_guess)
    if (const auto failure = p_.guards.paths.judge_path(false)) {
      report.reject(*failure);
      return false;
    }
  problem.clear_obstacle();
  if (has_guess)
    return true;
  report.failure = !parts.tools().failure().empty()              ? parts.tools().failure()
                   : !parts.tangent().solver().failure().empty() ? parts.tangent().solver().failure()
                                                                 : "the initial guess is not admissible";
  return false;
}

NewtonReport StepAttempt::make(const double t, const double previous_step, const Way way) {
  NewtonReport report = solve(t, previous_step, way);
  if (!report.converged && !report.is_explained() && !p_.solver.is_probing())
    if (auto failure = p_.rules.explain(t)) {
      if (report.rejection == StepFailure::Kind::penetrates) // higher penalties come first
        failure->kind = StepFailure::Kind::penetrates;
      report.reject(*failure);
    }
  return report;
}

NewtonReport StepAttempt::solve(const double t, const double previous_step, const Way way) {
  NewtonReport report;
  begin(t);
  if (const auto failure = find_first_failure([&] { return p_.guards.paths.judge_turns(t); },
                                              [&] { return p_.guards.paths.judge_prescribed_motion(t); })) {
    report.reject(*failure);
    return report;
  }
  NewtonIteration linear_step{};
  if (!find_guess(t, previous_step, linear_step, report))
    return report;
  Unknowns x{p_.problem.step().trial.displacements, p_.problem.parts().tools().offsets()};
  p_.problem.parts().contacts().restart();
  const bool is_direct = way == Way::direct;
  report = is_direct
               ? p_.solver.iterate(x.offsets, x.displacements)
               : p_.continuation.iterate(way == Way::by_low_penalties ? PenaltyContinuation::Start::low
                                                                      : PenaltyContinuation::Start::enough,
                                         x.offsets, x.displacements);
  if (linear_step.force > 0.) // its cost is that of an iteration
    report.iterations.insert(report.iterations.begin(), linear_step);
  if (is_direct)
    report.hardest = report.iterations.size();
  p_.augmentation.augment(report, x.offsets, x.displacements);
  if (report.converged)
    stop_tools(t, x, report);
  if (report.converged)
    evaluate(x, report);
  if (report.converged && !p_.solver.is_probing())
    if (const auto failure = judge(t, report))
      report.reject(*failure);
  return report;
}

void StepAttempt::stop_tools(const double t, Unknowns &x, NewtonReport &report) {
  ImplicitProblem &problem = p_.problem;
  ImplicitParts &parts = problem.parts();
  stopping_ = parts.tools().find_stopping(
      t, [&](const std::size_t tool) { return parts.removal().is_removed(tool); });
  if (stopping_.empty())
    return;
  const bool has_measured = p_.measurement.has_begun();
  std::vector<std::size_t> pressing = parts.tools().unknown();
  pressing.insert(pressing.end(), stopping_.begin(), stopping_.end());
  parts.tools().choose_unknown(pressing);
  report.append(p_.solver.iterate(x.offsets, x.displacements));
  p_.augmentation.augment(report, x.offsets, x.displacements);
  if (has_measured) // it holds for the former position of the tool
    p_.measurement.spoil();
}

void StepAttempt::evaluate(Unknowns &x, NewtonReport &report) {
  ImplicitProblem &problem = p_.problem;
  ImplicitParts &parts = problem.parts();
  // The line search may have evaluated other states since: the histories have to be those of the
  // accepted state.
  Vector accepted = parts.tools().pack(x.displacements, x.offsets);
  Vector residual(accepted);
  problem.compute_residual(accepted, residual);
  if (p_.solver.is_probing())
    return;
  balance(x, report);
  if (!p_.measurement.is_wanted())
    return;
  accepted = parts.tools().pack(x.displacements, x.offsets);
  p_.measurement.measure(accepted, p_.solver.accuracy(), report);
  problem.compute_residual(accepted, residual);
  const double allowed = p_.measurement.find_allowed();
  if (allowed == 0.)
    return;
  p_.augmentation.allow_penetration(allowed);
  p_.augmentation.augment(report, x.offsets, x.displacements);
  accepted = parts.tools().pack(x.displacements, x.offsets);
  problem.compute_residual(accepted, residual);
}

void StepAttempt::balance(Unknowns &x, NewtonReport &report) {
  double part = p_.guards.resultants.find_part();
  if (!p_.guards.resultants.is_hopeful() || report.is_stalled || report.is_lost_in_round_off)
    return;
  for (unsigned int n = 0; n < StepAttemptLimits::max_refinements && part > ResultantGuard::allowed; ++n) {
    const Unknowns before = x;
    const NewtonReport refined = p_.solver.refine(
        std::max(StepAttemptLimits::min_factor, StepAttemptLimits::aim * ResultantGuard::allowed / part),
        x.offsets, x.displacements);
    if (refined.converged)
      report.append(refined);
    else {
      x = before;
      report.iterations.insert(report.iterations.end(), refined.iterations.begin(), refined.iterations.end());
    }
    Vector state = p_.problem.parts().tools().pack(x.displacements, x.offsets), residual(state);
    p_.problem.compute_residual(state, residual);
    part = p_.guards.resultants.find_part();
    if (!refined.converged)
      break;
  }
  p_.guards.resultants.note(part <= ResultantGuard::allowed);
}

std::optional<StepFailure> StepAttempt::judge(const double t, NewtonReport &report) {
  return find_first_failure(
      [&] { return p_.guards.round_off.judge(t, report); },
      [&] { return p_.rules.balance().judge_accuracy(t); },
      [&] { return p_.guards.paths.judge_thin_tools(); }, [&] { return p_.guards.paths.judge_path(true); },
      [&] { return p_.guards.paths.judge_turns(t); }, [&] { return p_.rules.judge(t, report.diagnostics); });
}

} // namespace billet
