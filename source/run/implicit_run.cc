// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/implicit_run.h"

#include "billet/diagnostic_kinds.h"
#include "billet/output/element_means.h"
#include "billet/run/error_estimates.h"
#include "billet/run/failure.h"
#include "billet/run/forming_limits.h"
#include "billet/run/unneeded_costs.h"
#include "billet/spent_time.h"

#include <algorithm>

namespace billet {

namespace {

struct ImplicitRunLimits {
  /// Number of cuts in a row after which the step starts from low penalties.
  static constexpr unsigned int max_cuts_in_a_row = 4;
};

EnergyWatch make_energy_watch(const parameters::Scene &parameters) {
  const double max_drift = parameters.scheme().has_inertia ? parameters.implicit_dynamics.max_drift : 0.;
  return max_drift > 0.                    ? EnergyWatch(EnergyWatch::Balance::is_kept, max_drift)
         : parameters.scheme().has_inertia ? EnergyWatch(EnergyWatch::Balance::is_reported)
                                           : EnergyWatch(EnergyWatch::Balance::is_left);
}

bool has_sticking_overlaps(const Scene &scene) {
  return std::any_of(scene.body_pairs().begin(), scene.body_pairs().end(), [](const BodyPair &pair) {
    return pair.has_friction() && pair.facets == FacetMethod::overlap;
  });
}

/// Whether a step has the length of a 'Maximum step' that the scene itself sets.
bool is_limited(const double length, const parameters::Scene &parameters) {
  constexpr double rounding = 1e-6;
  return length >= parameters.time_stepping.max_step * (1. - rounding) &&
         std::none_of(parameters.presets.begin(), parameters.presets.end(),
                      [](const parameters::Preset &preset) { return preset.key == "Maximum step"; });
}

} // namespace

ImplicitRun::ImplicitRun(const Scene &scene, const MPI_Comm communicator, Resumption *resumption)
    : Run(scene, communicator, resumption), problem_(scene, discretization_),
      control_(parameters_.time_stepping, parameters_.output.interval, load_problem(resumption)),
      energies_(make_energy_watch(parameters_)) {
  if (parameters_.scheme().has_inertia && parameters_.target_error > 0.)
    errors_ = std::make_unique<EnergyErrors>(parameters_.target_error);
  else if (ErrorWatch::is_wanted(parameters_))
    watch_ = std::make_unique<ErrorWatch>(scene, discretization_, problem_);
  if (resumption != nullptr)
    load_control(*resumption);
}

double ImplicitRun::release_time(const Resumption &resumption) const {
  return resumption.is_refinement() ? refinement_release_time(parameters_) : parameters_.restart.release_time;
}

std::vector<double> ImplicitRun::load_problem(Resumption *resumption) {
  std::vector<double> stops = scene_.stops();
  if (resumption != nullptr) {
    resumption->load(scene_, discretization_,
                     [&] { return problem_.load(resumption->state(), release_time(*resumption)); });
    stops.push_back(resumption->report().release_end);
  }
  return stops;
}

void ImplicitRun::load_control(Resumption &resumption) {
  const RestartReport &start = resumption.report();
  StateReader &reader = resumption.state();
  control_.begin(start.time, 0);
  if (watch_)
    watch_->begin(start.time);
  if (errors_)
    errors_->begin(start.time);
  if (reader.has("steps"))
    resumption.in("steps", [&] {
      control_.load(reader);
      const std::vector<double> totals = reader.read("totals", 2);
      continued_ = start.is_exact ? totals.at(0) : 0.;
      report_.total_iterations = to_count(totals.at(1));
      report_.total_cuts = control_.n_cuts();
      if (watch_)
        watch_->load(reader);
      review_.load(reader);
      mesh_errors_.load(reader);
      if (errors_ && reader.has("errors"))
        errors_->load(reader);
    });
}

void ImplicitRun::save_method(StateWriter &writer) const {
  writer.in("solution", [&] { problem_.save(writer); });
  writer.in("steps", [&] {
    control_.save(writer);
    writer.write("totals", {continued_, static_cast<double>(report_.total_iterations)});
    if (watch_)
      watch_->save(writer);
    if (errors_)
      errors_->save(writer);
    review_.save(writer);
    mesh_errors_.save(writer);
  });
}

void ImplicitRun::begin(RunOutput &output, const Resumption *resumption) {
  announce(problem_, output, resumption, parameters_.solver.force_tolerance);
  problem_.set_mesh_errors(mesh_errors_);
  if (!mesh_errors_.has_begun())
    mesh_errors_.add(problem_);
  if (resumption == nullptr || !(resumption->report().is_exact || resumption->is_refinement()))
    output.snapshots().write(problem_);
}

bool ImplicitRun::step(RunOutput &output) {
  if (watch_)
    report_.total_iterations += watch_->before_step(control_, continued_);
  const double from = control_.time(), to = control_.next_time();
  report_.length = to - from;
  const TimedWork timed(Work::limited_steps, watch_ && is_limited(report_.length, parameters_));
  try {
    report_.newton = problem_.step(to, continued_);
  } catch (const SolutionFailure &) { // keep the results so far
    output.snapshots().write(problem_);
    throw;
  }
  report_.total_iterations += static_cast<unsigned int>(report_.newton.iterations.size());
  output.report(report_.newton.diagnostics);
  if (!report_.newton.converged) {
    reject_step(from, to, output);
    return false;
  }
  control_.accept(static_cast<unsigned int>(report_.newton.hardest), problem_.balance().time_error());
  n_failed_ = 0;
  return true;
}

void ImplicitRun::reject_step(const double from, const double to, RunOutput &output) {
  const NewtonReport &newton = report_.newton;
  output.progress().reject(report_, from, to);
  if (watch_)
    watch_->after_failure();
  // If round-off limits the residual, smaller load steps make it worse.
  bool may_continue = control_.reject() && !newton.is_lost_in_round_off;
  report_.total_cuts = control_.n_cuts();
  if (!may_continue && !newton.is_lost_in_round_off && !newton.is_explained()) {
    may_continue = problem_.equation().parts().tangent().take_exact();
    if (may_continue)
      output.report(Diagnostic(diagnostic::exact_tangent,
                               "Newton's method failed with this 'Contact tangent'; the run "
                               "uses the exact one from here on, with an unsymmetric matrix")
                        .time(from));
  }
  // Steps that fail whatever their length need another start, as do those that cannot be cut.
  if (!newton.is_lost_in_round_off && !newton.is_explained() &&
      (!may_continue || ++n_failed_ >= ImplicitRunLimits::max_cuts_in_a_row))
    may_continue = problem_.take_low_penalties() || may_continue;
  if (may_continue)
    return;
  output.snapshots().write(problem_);
  throw SolutionFailure(explain_failed_step(scene_, report_, from, to, stability_.has_unstable_bodies()));
}

void ImplicitRun::after_step(RunOutput &output) {
  control_errors(output);
  continued_ = report_.length;
  report_.step = control_.n_steps();
  mesh_errors_.add(problem_);
  const std::vector<double> probes = probes_.read(problem_);
  output.write_row([&](HistoryFile &history) { history.write(report_, problem_, probes); });
  output.progress().set_probes(probes);
  output.progress().accept(report_, problem_);
  output.report(check_force_balance(problem_.reactions().balance, problem_.state().time, false));
  output.report(review_.after_step(problem_, control_.is_finished()));
  output.report(stability_.check(problem_.state()));
  output.report(softening_.check(problem_));
  check_energies(output);
  output.snapshots().after_step(control_.n_steps(), problem_);
}

void ImplicitRun::control_errors(RunOutput &output) {
  if (watch_) {
    watch_->after_step(control_, report_.length, report_.newton);
    output.report(watch_->check(control_));
  }
  if (errors_) {
    const double factor = errors_->step_factor();
    errors_->add(control_.time(), problem_.state().energies,
                 carried_energy(scene_.free_directions(), problem_.state().momentum,
                                problem_.equation().parts().scheme().mass()));
    if (errors_->step_factor() < factor)
      control_.limit(errors_->step_factor() * report_.length);
  }
}

EnergyWatch::Cause ImplicitRun::find_cause_of_imbalance() const {
  return stability_.has_unstable_bodies() ? EnergyWatch::Cause::unstable_law
         : problem_.has_low_penalties()   ? EnergyWatch::Cause::low_penalties
         : has_inexact_dissipation(scene_, discretization_, problem_)
             ? EnergyWatch::Cause::inexact_dissipation
         : has_sticking_overlaps(scene_)             ? EnergyWatch::Cause::sticking_overlaps
         : problem_.balance().contact_makes_energy() ? EnergyWatch::Cause::contact_edges
                                                     : EnergyWatch::Cause::steps;
}

void ImplicitRun::check_energies(RunOutput &output) {
  output.report(energies_.check(control_.time(), problem_.state().energies,
                                [this] { return find_cause_of_imbalance(); }));
  if (energies_.imbalance().empty())
    return;
  output.snapshots().write(problem_);
  throw SolutionFailure(explain_imbalance(parameters_, report_, control_.time(), energies_.imbalance()));
}

void ImplicitRun::end(RunOutput &output) {
  output.report(review_.finish());
  output.report(problem_.finish());
  if (watch_)
    report_errors(make_report(*watch_, report_), mesh_errors_, discretization_, parameters_, review_, output);
  if (errors_) {
    ErrorReport estimate = make_report(*errors_, "Reduce 'Maximum step'");
    estimate.costs = {{"steps taken", report_.step}, {"Newton iterations", report_.total_iterations}};
    report_errors(std::move(estimate), mesh_errors_, discretization_, parameters_, review_, output);
  }
  output.report(describe_mesh_errors(mesh_errors_, review_, parameters_));
  RunCosts costs = collect_costs(scene_, problem_, review_);
  if (watch_) {
    costs.steps_error = watch_->estimated_error().estimate.steps;
    costs.target = parameters_.target_error;
  }
  output.report(find_unneeded_costs(costs));
  output.report(find_checkerboard(problem_, discretization_).check());
  output.report(check_forming_limits(scene_, problem_));
}

} // namespace billet
