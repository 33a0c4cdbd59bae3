// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/step_control.h"

#include "billet/times.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace billet {

namespace {

/// Rules of steps beside those that the scene sets.
struct Rules {
  /// Part of a step by which round-off may misplace its end.
  static constexpr double slack = 1e-8;
  /// Number of remaining steps below which two equal steps are taken, rather than a full step and a
  /// short rest.
  static constexpr double halves = 1.5;
  /// Part of the step that an error of its time integration allows; the error falls with its third
  /// power.
  static constexpr double safety = 0.8;
};

} // namespace

StepControl::StepControl(const parameters::TimeStepping &parameters, const double interval,
                         std::vector<double> stops)
    : parameters_(parameters), interval_(interval), stops_(std::move(stops)), step_(parameters.initial_step) {
  stops_.insert(stops_.end(), parameters.stops.begin(), parameters.stops.end());
  std::sort(stops_.begin(), stops_.end());
  // 0.7 + 0.1 differs from 0.8 in the last bit. A step of this length has no meaning; the later
  // stop counts.
  std::size_t n = 0;
  for (std::size_t i = 0; i < stops_.size(); ++i) {
    const double next = i + 1 < stops_.size() ? stops_[i + 1] : parameters.end_time;
    if (times::is_before(stops_[i], next))
      stops_[n++] = stops_[i];
  }
  stops_.resize(n);
}

double StepControl::next_stop() const {
  const auto next = std::upper_bound(stops_.begin(), stops_.end(), time_);
  return next != stops_.end() ? *next : std::numeric_limits<double>::infinity();
}

double StepControl::target() const {
  const double target = std::min(parameters_.end_time, next_stop());
  if (interval_ == 0.)
    return target;
  const double output = (times::count_intervals(time_, interval_) + 1.) * interval_;
  // Round-off, as of 100 times 0.29 < 29, must not cause a tiny step.
  return output < target - Rules::slack * interval_ ? output : target;
}

double StepControl::next_time() const {
  const double target = this->target();
  if (parameters_.control == parameters::TimeStepping::Control::fixed)
    return end_on_grid() >= target - Rules::slack * step_ ? target : end_on_grid();
  const double remaining = target - time_;
  if (remaining <= step_ * (1. + Rules::slack))
    return target;
  return time_ + (remaining < Rules::halves * step_ ? 0.5 * remaining : step_);
}

bool StepControl::ends_at_stop() const { return next_time() >= next_stop(); }

double StepControl::end_on_grid() const { return grid_start_ + (n_on_grid_ + 1) * step_; }

double StepControl::next_step() const { return next_time() - time_; }

void StepControl::accept(const unsigned int n_iterations, const double error) {
  const double taken = next_step();
  time_ = next_time();
  ++n_steps_;
  if (parameters_.control == parameters::TimeStepping::Control::fixed) {
    const bool was_cut = time_ < end_on_grid() - Rules::slack * step_;
    grid_start_ = was_cut ? time_ : grid_start_;
    n_on_grid_ = was_cut ? 0 : n_on_grid_ + 1;
    return;
  }
  if (n_iterations <= parameters_.few_iterations)
    step_ = std::min(parameters_.max_step, std::max(step_, taken) * parameters_.growth_factor);
  else if (n_iterations >= parameters_.many_iterations)
    step_ = std::max(parameters_.min_step, taken * parameters_.shrink_factor);
  if (error > 0.)
    step_ = std::max(parameters_.min_step, std::min(step_, Rules::safety / std::cbrt(error) * taken));
}

double StepControl::time_after_next() const {
  StepControl next(*this);
  next.time_ = next_time();
  next.step_ = next_step();
  return next.next_time();
}

void StepControl::limit(const double length) {
  step_ = std::max(parameters_.min_step, std::min(step_, length));
}

void StepControl::plan(const double length) { step_ = length; }

bool StepControl::reject() {
  ++n_cuts_;
  const double failed = next_step();
  if (parameters_.control == parameters::TimeStepping::Control::fixed ||
      failed <= parameters_.min_step * (1. + Rules::slack))
    return false;
  step_ = std::max(parameters_.min_step, failed * parameters_.cut_factor);
  return true;
}

std::vector<double> StepControl::rules() const {
  const parameters::TimeStepping &p = parameters_;
  return {p.control == parameters::TimeStepping::Control::fixed ? 1. : 0.,
          p.initial_step,
          p.min_step,
          p.max_step,
          static_cast<double>(p.few_iterations),
          static_cast<double>(p.many_iterations),
          p.growth_factor,
          p.shrink_factor,
          p.cut_factor};
}

void StepControl::save(StateWriter &writer) const {
  writer.write("rules", rules());
  writer.write("state", {time_, step_, grid_start_, static_cast<double>(n_on_grid_),
                         static_cast<double>(n_steps_), static_cast<double>(n_cuts_)});
}

void StepControl::load(const StateReader &reader) {
  const std::vector<double> state = reader.read("state", 6);
  begin(state.at(0), to_count(state.at(4)));
  n_cuts_ = to_count(state.at(5));
  if (reader.read("rules") != rules())
    return;
  step_ = state.at(1);
  grid_start_ = state.at(2);
  n_on_grid_ = to_count(state.at(3));
}

void StepControl::begin(const double time, const unsigned int n_steps) {
  time_ = grid_start_ = time;
  n_on_grid_ = 0;
  n_steps_ = n_steps;
}

} // namespace billet
