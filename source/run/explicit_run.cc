// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/explicit_run.h"

#include "billet/diagnostic_kinds.h"
#include "billet/output/element_means.h"
#include "billet/run/error_estimates.h"
#include "billet/run/failure.h"
#include "billet/run/forming_limits.h"
#include "billet/run/unneeded_costs.h"
#include "billet/scene/plausibility.h"
#include "billet/times.h"

#include <cmath>
#include <iomanip>
#include <sstream>

namespace billet {

namespace {

constexpr unsigned int steps_between_checks = ExplicitDynamics::steps_between_checks;
/// Least number of steps between two watched states, each of which costs about four steps.
constexpr unsigned int steps_between_watches = 20;
/// Steps between two states of (W4), each of which costs eleven steps.
constexpr unsigned int steps_between_estimates = 400;
/// Number of intervals of (W4) in a run: waves pass the bodies meanwhile.
constexpr double n_intervals = 20.;

struct ExplicitRunLimits {
  /// Number of checks of stability in a run: each costs one to a few steps.
  static constexpr double n_checks = 100.;
  /// Added mass over the mass, and kinetic over internal energy, above which mass scaling changes
  /// the motion.
  static constexpr double much_mass = 0.1, fast = 0.05;
};

Diagnostic describe_mass_scaling(const ExplicitDynamics &problem) {
  std::ostringstream text;
  text << "Mass scaling adds " << problem.added_mass() << " to the bodies' " << problem.mass() << " ("
       << std::setprecision(3) << 100. * problem.added_mass() / problem.mass() << " %)";
  return Diagnostic(diagnostic::mass_scaling, text.str())
      .value("mass", problem.mass())
      .value("added mass", problem.added_mass());
}

/// Returns a warning at the end of a run if the added mass changes the motion.
DiagnosticList check_mass_scaling(const ExplicitDynamics &problem, const RunReview &review) {
  const double added = problem.added_mass() / problem.mass(), kinetic = review.kinetic_part();
  if (!(added > ExplicitRunLimits::much_mass && kinetic > ExplicitRunLimits::fast))
    return {};
  std::ostringstream text;
  text.precision(3);
  text << "Mass scaling adds " << 100. * added << " % to the mass, and the kinetic energy reaches "
       << 100. * kinetic << " % of the internal energy";
  return {Diagnostic(diagnostic::mass_scaling_too_strong, text.str())
              .measure("added mass / mass", added)
              .value("kinetic / internal energy", kinetic)};
}

} // namespace

ExplicitRun::ExplicitRun(const Scene &scene, const MPI_Comm communicator, Resumption *resumption)
    : Run(scene, communicator, resumption), problem_(scene, discretization_), stops_(scene),
      history_times_(stops_.end(), parameters_.output.history_interval), watch_times_(stops_.end(), 0.) {
  if (parameters_.target_error > 0.)
    errors_ = std::make_unique<EnergyErrors>(parameters_.target_error);
  if (resumption != nullptr)
    load(*resumption);
}

void ExplicitRun::load(Resumption &resumption) {
  resumption.load(scene_, discretization_, [&] { return problem_.load(resumption.state()); });
  StateReader &reader = resumption.state();
  problem_.plan_to(stops_.next(problem_.time()));
  if (errors_)
    errors_->begin(problem_.time());
  if (!resumption.report().is_exact || !reader.has("rows"))
    return;
  resumption.in("rows", [&] {
    // If the interval has changed, the next row is due at once.
    if (reader.number("interval") == history_times_.interval())
      history_times_.begin_after(reader.number("last"));
    if (reader.number("interval of checks") == watch_times_.interval())
      watch_times_.begin_after(reader.number("last check"));
    last_.balanced_step = reader.count("balanced step");
    last_.watched_step = reader.count("watched step");
    last_.estimated_step = reader.count("estimated step");
    last_.interval_start = reader.number("interval start");
    review_.load(reader);
    mesh_errors_.load(reader);
    if (errors_ && reader.has("errors")) {
      errors_->load(reader);
      problem_.shorten_steps(errors_->step_factor());
    }
  });
}

void ExplicitRun::save_method(StateWriter &writer) const {
  writer.in("solution", [&] { problem_.save(writer); });
  writer.in("rows", [&] {
    writer.write("interval", {history_times_.interval()});
    writer.write("last", {history_times_.last()});
    writer.write("interval of checks", {watch_times_.interval()});
    writer.write("last check", {watch_times_.last()});
    writer.write("watched step", {static_cast<double>(last_.watched_step)});
    writer.write("balanced step", {static_cast<double>(last_.balanced_step)});
    writer.write("estimated step", {static_cast<double>(last_.estimated_step)});
    writer.write("interval start", {last_.interval_start});
    review_.save(writer);
    mesh_errors_.save(writer);
    if (errors_)
      errors_->save(writer);
  });
}

void ExplicitRun::begin(RunOutput &output, const Resumption *resumption) {
  problem_.set_mesh_errors(mesh_errors_);
  first_step_ = problem_.n_steps();
  if (resumption != nullptr && resumption->is_refinement()) {
    change_ = resumption->change(); // its energy is known after the first forces
    return;
  }
  announce(problem_, output, resumption, 0.);
  if (parameters_.explicit_dynamics.scaled_step > 0.)
    output.report(describe_mass_scaling(problem_));
}

template <class Part> void ExplicitRun::attempt(RunOutput &output, const Part &part) {
  try {
    stopwatch_.measure(part);
  } catch (const SolutionFailure &failure) { // keep the results so far
    problem_.update_state();
    output.snapshots().write(problem_);
    if (std::isfinite(problem_.relative_drift()))
      output.report(stability_.check(problem_.state()));
    throw SolutionFailure(
        explain_failed_step(scene_, problem_, failure.diagnostic(), stability_.has_unstable_bodies()));
  }
}

bool ExplicitRun::step(RunOutput &output) {
  is_finished_ = problem_.time() >= stops_.end();
  is_between_steps_ = false;
  attempt(output, [&] {
    problem_.prepare_step(is_finished_ ? stops_.end() + problem_.step_length()
                                       : stops_.next(problem_.time()));
  });
  return true;
}

// The state between two steps has the springs of the earlier time. Compared with those of the finer
// mesh, all that they store in a step would seem gained, which is much at first touch.
EnergyLedger ExplicitRun::hand_over(RunOutput &output) {
  step(output);
  problem_.update_ledger();
  return problem_.state().energies;
}

void ExplicitRun::report_change(RunOutput &output) {
  if (!change_)
    return;
  problem_.update_ledger();
  RestartReport report;
  report.energy_change = problem_.count_refinement(change_->before);
  change_->check(parameters_.file_name, report.energy_change, problem_.state().energies);
  output.report(change_->describe(report, 0.));
  change_.reset();
}

bool ExplicitRun::is_watch_due() {
  const unsigned int n = problem_.n_steps();
  const bool is_near = n > 0 && n < last_.watched_step + steps_between_watches;
  if (is_near && !is_finished_)
    return false;
  const bool is_due = watch_times_.is_due(problem_.time()) || n == 0;
  if (is_due)
    last_.watched_step = n;
  return is_due;
}

void ExplicitRun::after_step(RunOutput &output) {
  report_change(output);
  if (problem_.n_steps() == 0)
    show_number_of_steps(output);
  const bool is_start = problem_.n_steps() == 0;
  const bool is_row_due = history_times_.is_due(problem_.time()) || is_start;
  const bool is_watched = is_watch_due();
  const bool is_check_due = problem_.n_steps() % steps_between_checks == 0;
  if (is_watched)
    estimate_mesh_error();
  if (is_row_due)
    write_row(output);
  if (is_watched)
    watch(output);
  if (!is_row_due && !is_watched && is_check_due)
    problem_.update_ledger();
  if (is_row_due || is_watched || is_check_due) {
    output.report(problem_.check_steps());
    check_stability(output);
    check_drift(output);
    control_errors();
  }
  write_fields(output);
  // A checkpoint stores the state at the start of the next step.
  if (!is_finished_ || output.checkpoints().is_regular()) {
    attempt(output, [&] { problem_.finish_step(); });
    is_between_steps_ = true;
  }
}

void ExplicitRun::estimate_mesh_error() {
  if (mesh_errors_.has_begun() && !is_finished_ &&
      problem_.n_steps() < last_.estimated_step + steps_between_estimates)
    return;
  problem_.update_state();
  const double interval = stops_.end() / n_intervals;
  const bool ends_interval =
      is_finished_ || !times::is_before(problem_.time(), last_.interval_start + interval);
  mesh_errors_.add(problem_, ends_interval);
  last_.estimated_step = problem_.n_steps();
  if (ends_interval)
    last_.interval_start = problem_.time();
}

void ExplicitRun::show_number_of_steps(RunOutput &output) const {
  const double n_steps = (stops_.end() - problem_.time()) / problem_.usual_step();
  output.progress().show_number_of_steps(n_steps, problem_.usual_step());
  if (n_steps > too_many_steps && !output.has(diagnostic::many_steps))
    output.report(Diagnostic(diagnostic::many_steps, "The run takes " + std::to_string(n_steps) + " steps")
                      .value("steps", n_steps));
}

void ExplicitRun::write_row(RunOutput &output) {
  if (probes_.empty())
    problem_.update_ledger();
  else
    problem_.update_state(); // probes read the fields, too
  const std::vector<double> probes = probes_.read(problem_);
  output.write_row([&](HistoryFile &history) {
    history.write(problem_.n_steps(), problem_.step_length(), problem_, probes);
  });
  output.progress().set_probes(probes);
  output.progress().show(problem_.n_steps(), problem_.step_length(), problem_);
}

void ExplicitRun::watch(RunOutput &output) {
  problem_.update_state();
  output.report(
      check_force_balance(problem_.reactions().balance, problem_.time(),
                          parameters_.explicit_dynamics.number_type == NumberType::float_precision));
  output.report(problem_.check_penalties());
  output.report(review_.after_step(problem_, problem_.time() >= stops_.end()));
  output.report(energies_.check(problem_.time(), problem_.state().energies));
}

void ExplicitRun::write_fields(RunOutput &output) {
  const bool is_start = problem_.n_steps() == 0;
  if (!is_start && !output.snapshots().is_due(problem_.n_steps(), problem_.time()))
    return;
  problem_.update_state();
  if (is_start)
    output.snapshots().write(problem_);
  else
    output.snapshots().after_step(problem_.n_steps(), problem_);
}

void ExplicitRun::check_stability(RunOutput &output) {
  if (problem_.time() < last_.next_check || !std::isfinite(problem_.relative_drift()))
    return;
  problem_.update_state();
  output.report(stability_.check(problem_.state()));
  output.report(softening_.check(problem_));
  last_.next_check = problem_.time() + stops_.end() / ExplicitRunLimits::n_checks;
}

std::string ExplicitRun::advise_on_law(RunOutput &output) {
  output.report(stability_.check(problem_.state()));
  if (stability_.has_unstable_bodies())
    return EnergyWatch::advise(EnergyWatch::Cause::unstable_law);
  if (softening_.has_softened())
    return EnergyWatch::advise(EnergyWatch::Cause::softening);
  if (!problem_.has_low_penalties() && has_inexact_dissipation(scene_, discretization_, problem_))
    return EnergyWatch::advise(EnergyWatch::Cause::inexact_dissipation);
  return "";
}

// At first contact, up to a quarter of the total energy may be the error of the step in which a
// node penetrates. This fraction soon becomes small, whereas an instability keeps growing.
void ExplicitRun::check_drift(RunOutput &output) {
  const bool is_finite = std::isfinite(problem_.relative_drift());
  if (std::abs(problem_.relative_drift()) <= parameters_.explicit_dynamics.max_drift)
    last_.balanced_step = problem_.n_steps();
  if (is_finite && problem_.n_steps() < last_.balanced_step + (is_finished_ ? 1 : steps_between_checks))
    return;
  problem_.update_state();
  output.snapshots().write(problem_);
  const std::string advice = is_finite ? advise_on_law(output) : "";
  throw SolutionFailure(explain_drift(scene_, problem_, advice));
}

void ExplicitRun::control_errors() {
  if (!errors_)
    return;
  errors_->add(problem_.time(), problem_.state().energies,
               carried_energy(scene_.free_directions(), problem_.state().momentum,
                              problem_.mass() + problem_.added_mass()));
  problem_.shorten_steps(errors_->step_factor());
}

void ExplicitRun::end(RunOutput &output) {
  output.report(review_.finish());
  output.report(problem_.finish());
  output.report(check_mass_scaling(problem_, review_));
  if (errors_) {
    ErrorReport report = make_report(*errors_, "Reduce 'Safety factor'");
    report.costs = {{"steps taken", problem_.n_steps()},
                    {"element updates", static_cast<double>(problem_.n_steps()) *
                                            static_cast<double>(discretization_.n_global_elements())}};
    problem_.update_state();
    report_errors(report, mesh_errors_, discretization_, parameters_, review_, output);
  }
  output.progress().show_pace(problem_.n_steps() - first_step_, discretization_.n_global_elements(),
                              stopwatch_.seconds(), stopwatch_.processor_seconds());
  problem_.update_state();
  output.report(describe_mesh_errors(mesh_errors_, review_, parameters_));
  output.report(check_forming_limits(scene_, problem_));
  output.report(find_unneeded_costs(collect_costs(scene_, problem_, review_)));
  output.report(find_checkerboard(problem_, discretization_).check());
}

} // namespace billet
