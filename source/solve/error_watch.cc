// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/error_watch.h"

#include "billet/diagnostic_kinds.h"
#include "billet/solve/error_budget.h"
#include "billet/solve/restart.h"
#include "billet/spent_time.h"
#include "billet/usage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace billet {

namespace {

struct ErrorWatchLimits {
  /// A residual of the norm r sums up to a resultant of at most √N r over N nodes. Contact forces
  /// of the norm f on N^⅔ nodes of a surface have a resultant of about √(N^⅔) f. Relative residuals
  /// of resultants are thus those of nodal forces times N to this power, 1/2 − 1/3.
  static constexpr double power_of_sums = 1. / 6.;
};

/// Whether the penetration tolerances of all pairs are left to the target error.
bool may_choose_penetration(const parameters::Scene &parameters) {
  return parameters.target_error > 0. && !parameters.pairs.empty() &&
         static_cast<std::size_t>(std::count_if(parameters.presets.begin(), parameters.presets.end(),
                                                [](const parameters::Preset &preset) {
                                                  return preset.key == "Penetration tolerance";
                                                })) == parameters.pairs.size();
}

/// Whether stresses or dashpots depend on the steps: their errors persist.
bool has_path(const Scene &scene) {
  return std::any_of(scene.bodies().begin(), scene.bodies().end(), [](const Body &body) {
    return depends_on_path(*body.law) ||
           std::any_of(body.loads.begin(), body.loads.end(),
                       [](const AppliedLoad &load) { return load.load.is_viscous(); });
  });
}

/// Whether the solution depends on the step length: by the path, or by tractions on a friction
/// cone. Errors of tractions fade.
bool depends_on_steps(const Scene &scene) { return scene.capabilities().friction || has_path(scene); }

ErrorControl::Tolerances tolerances_of(const Scene &scene) {
  const parameters::Scene &parameters = scene.parameters();
  const double target = parameters.target_error;
  return {parameters.time_stepping.error_tolerance,
          may_choose_penetration(parameters) ? ErrorBudget::of_penetration(target, depends_on_steps(scene))
                                             : 0.,
          !has_path(scene)};
}

ErrorControl::Tolerances tolerances_of_travels(const Scene &scene) {
  ErrorControl::Tolerances tolerances = tolerances_of(scene);
  tolerances.stays = true;
  return tolerances;
}

} // namespace

bool ErrorWatch::is_wanted(const parameters::Scene &parameters) {
  return parameters.target_error > 0. || parameters.time_stepping.error_tolerance > 0.;
}

ErrorWatch::ErrorWatch(const Scene &scene, const Discretization &discretization, ImplicitSolution &problem)
    : problem_(problem),
      controls_(1, ErrorControl(tolerances_of(scene), scene.parameters().time_stepping.end_time)),
      residual_factor_(
          std::pow(static_cast<double>(discretization.n_global_elements()), ErrorWatchLimits::power_of_sums)),
      end_time_(scene.parameters().time_stepping.end_time), measures_steps_(depends_on_steps(scene)),
      measures_penetration_(scene.parameters().target_error > 0. &&
                            !(scene.pairs().empty() && scene.body_pairs().empty())),
      controls_penetration_(may_choose_penetration(scene.parameters())),
      accuracy_of_measurements_(scene.parameters().target_error > 0.
                                    ? std::min(1., ErrorBudget::residual(scene.parameters().target_error) /
                                                       scene.parameters().solver.force_tolerance)
                                    : 1.) {
  controls_.resize(problem.results().names().size(), ErrorControl(tolerances_of_travels(scene), end_time_));
  memory_.set(sizeof(*this) + controls_.size() * sizeof(ErrorControl));
  allow_penetration();
}

void ErrorWatch::begin(const double time) {
  for (auto &control : controls_)
    control.begin(time);
}

double ErrorWatch::minimum(double (ErrorControl::*bound)() const) const {
  double minimum = std::numeric_limits<double>::infinity();
  for (const auto &control : controls_)
    minimum = std::min(minimum, (control.*bound)());
  return minimum;
}

bool ErrorWatch::wants_measurement(const double length) const {
  return std::any_of(controls_.begin(), controls_.end(),
                     [length](const ErrorControl &control) { return control.wants_measurement(length); });
}

bool ErrorWatch::wants_penetration() const {
  return std::any_of(controls_.begin(), controls_.end(),
                     [](const ErrorControl &control) { return control.wants_penetration(); });
}

void ErrorWatch::miss_measurement(const double length, const bool failed) {
  for (auto &control : controls_)
    control.miss_measurement(length, failed);
}

ErrorWatch::EstimatedError ErrorWatch::estimated_error() const {
  const std::vector<std::string> names = problem_.results().names();
  EstimatedError estimated_error;
  for (std::size_t i = 0; i < controls_.size(); ++i) {
    const ErrorControl::Estimate estimate = controls_[i].estimate();
    if (controls_[i].has_forces() &&
        (!estimated_error.has_results || estimate.total() > estimated_error.estimate.total()))
      estimated_error = {estimate, names[i], controls_[i].start(), true, controls_[i].knows_penetration()};
  }
  if (!estimated_error.has_results)
    estimated_error.of_what = names.front();
  return estimated_error;
}

void ErrorWatch::allow_penetration() {
  penetration_allowed_ = minimum(&ErrorControl::penetration_allowed);
  if (controls_penetration_)
    problem_.set_penetration_allowed(penetration_allowed_);
}

void ErrorWatch::demand_accuracy(const bool is_measured) {
  problem_.set_accuracy(is_measured ? accuracy_of_measurements_ : 1.);
}

unsigned int ErrorWatch::before_step(StepControl &control, const double previous_step) {
  const TimedWork timed(Work::error_control);
  Usage::count(Capability::error_control, 1);
  const bool is_second = probe_length_ > 0.;
  const unsigned int n_iterations = measures_steps_ && !is_second ? probe(control, previous_step) : 0;
  // Not in the first of the steps that are compared: they need the same penetration.
  if (measures_penetration_ && wants_penetration() && (is_second || probe_length_ == 0.))
    problem_.measurement().ask(minimum(&ErrorControl::allowed_at_first));
  return n_iterations;
}

unsigned int ErrorWatch::probe(StepControl &control, const double previous_step) {
  if (!wants_measurement(control.next_step()))
    return 0;
  const double first = control.next_step(), end = control.time_after_next(),
               second = end - control.next_time();
  if (control.ends_at_stop() ||                 // the longer step would cross the stop
      !ErrorBudget::are_equal(first, second)) { // a stop is near: measure after it
    miss_measurement(first, false);
    return 0;
  }
  demand_accuracy(true);
  probe_ = problem_.probe(end, previous_step);
  const auto n_iterations = static_cast<unsigned int>(probe_.newton.iterations.size());
  n_iterations_ += n_iterations;
  if (probe_.newton.converged) {
    probe_length_ = first;
    probe_end_ = end;
  } else {
    demand_accuracy(false);
    miss_measurement(first, true);
    control.limit(minimum(&ErrorControl::longest_step));
  }
  return n_iterations;
}

void ErrorWatch::take_measurement() {
  const auto measured = problem_.measurement().take();
  if (!measured)
    return;
  n_iterations_ += measured->n_iterations;
  for (std::size_t i = 0; i < controls_.size(); ++i)
    if (measured->without.empty())
      controls_[i].miss_penetration(measured->penetration > 0.);
    else
      controls_[i].measure_penetration(measured->penetration, measured->with[i], measured->without[i],
                                       residual_factor_ * measured->residual);
}

void ErrorWatch::after_step(StepControl &control, const double length, const NewtonReport &report) {
  const ImplicitSolution::Results results = problem_.results().accepted();
  const std::vector<double> min_sizes = problem_.results().min_sizes();
  for (std::size_t i = 0; i < controls_.size(); ++i) {
    controls_[i].set_min_size(min_sizes[i]);
    controls_[i].accept(length, results[i], residual_factor_ * report.force, problem_.penetration());
  }
  if (probe_length_ > 0. && control.time() < probe_end_) {
    control.plan(probe_length_);
    last_residual_ = report.force;
    return;
  }
  if (probe_length_ > 0.)
    for (std::size_t i = 0; i < controls_.size(); ++i)
      controls_[i].measure_steps(probe_length_, results[i], probe_.results[i],
                                 residual_factor_ * (report.force + last_residual_ + probe_.newton.force));
  take_measurement();
  allow_penetration();
  if (!measures_steps_)
    return;
  probe_length_ = 0.;
  demand_accuracy(false);
  last_residual_ = report.force;
  control.limit(minimum(&ErrorControl::longest_step));
}

void ErrorWatch::after_failure() {
  if (probe_length_ > 0.)
    miss_measurement(probe_length_, true);
  probe_length_ = 0.;
  demand_accuracy(false);
}

DiagnosticList ErrorWatch::check(const StepControl &control) const {
  const bool has_given_up = std::any_of(controls_.begin(), controls_.end(),
                                        [](const ErrorControl &errors) { return errors.has_given_up(); });
  DiagnosticList messages;
  if (has_given_up)
    messages.push_back(Diagnostic(diagnostic::comparison_failed,
                                  "There is no error estimate of the steps from here on, since the steps of "
                                  "twice the length for comparison do not converge")
                           .time(control.time()));
  if (control.is_finished() || !(control.next_step() > 0.) || probe_length_ > 0.)
    return messages;
  const double to_come = (end_time_ - control.time()) / control.next_step();
  if (!ErrorBudget::is_expensive(to_come))
    return messages;
  std::ostringstream text;
  text.precision(2);
  text << "The allowed error requires steps of " << control.next_step()
       << " now; at that length the run needs " << to_come << " more";
  messages.push_back(Diagnostic(diagnostic::target_error_expensive, text.str())
                         .time(control.time())
                         .measure("steps to come", to_come));
  return messages;
}

void ErrorWatch::save(StateWriter &writer) const {
  const std::vector<std::string> names = problem_.results().names();
  for (std::size_t i = 0; i < controls_.size(); ++i)
    writer.in(group("results", i), [&] {
      writer.write_text("name", names[i]);
      controls_[i].save(writer);
      // Between two compared steps the probe's results are saved, too.
      billet::save(writer, "probed", probe_length_ > 0. ? probe_.results[i] : ResultGroup());
    });
  writer.write("iterations of measurements", {static_cast<double>(n_iterations_)});
  writer.write("comparison", {probe_length_, probe_end_, last_residual_, probe_.newton.force});
  writer.write("penetration allowed", {penetration_allowed_});
}

void ErrorWatch::load(StateReader &reader) {
  const std::vector<std::string> names = problem_.results().names();
  probe_.results.assign(names.size(), {});
  bool is_whole = true;
  for (std::size_t i = 0; i < controls_.size(); ++i) {
    const auto found = find_group(reader, "results", names[i]); // none for a new tool
    is_whole = is_whole && found.has_value();
    if (found)
      reader.in(group("results", *found), [&] {
        controls_[i].load(reader);
        probe_.results[i] = load_result_group(reader, "probed");
      });
  }
  if (!reader.has("comparison")) // an earlier run without error control
    return;
  allow_penetration();
  n_iterations_ = reader.count("iterations of measurements");
  const std::vector<double> comparison = reader.read("comparison", 4);
  probe_length_ = is_whole ? comparison.at(0) : 0.;
  probe_end_ = comparison.at(1);
  // Between two compared steps the penetration of the first is allowed, whatever the errors are.
  if (controls_penetration_ && probe_length_ > 0. && reader.has("penetration allowed")) {
    penetration_allowed_ = reader.read("penetration allowed", 1).at(0);
    problem_.set_penetration_allowed(penetration_allowed_);
  }
  last_residual_ = comparison.at(2);
  probe_.newton.force = comparison.at(3);
  demand_accuracy(probe_length_ > 0.);
}

} // namespace billet
