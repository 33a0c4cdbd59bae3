// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/error_control.h"

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

double sum_of_norms(const ErrorControl::Forces &forces) {
  double sum = 0.;
  for (const auto &force : forces)
    sum += force.norm();
  return sum;
}

double distance(const ErrorControl::Forces &a, const ErrorControl::Forces &b) {
  double sum = 0.;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += (a[i] - b[i]).norm();
  return sum;
}

// Steps between measurements, at least, and where little changes from one to the next.
constexpr unsigned int shortest_interval = 2, longest_interval = 8;

} // namespace

double ErrorControl::force_scale() const { return std::max(last_force_, time_ > 0. ? work_ / time_ : 0.); }

double ErrorControl::leeway(const double spent, const double tolerance) {
  constexpr double least = 0.25, most = 1.5;
  return std::max(least, std::min(most, 2. - spent / tolerance));
}

void ErrorControl::accept(const double h, const Forces &forces, const double residual) {
  const double force = sum_of_norms(forces);
  work_ += 0.5 * (last_force_ + force) * h;
  time_ += h;
  last_force_ = force;
  iterations_ += residual * force * h;
  if (has_slope_)
    steps_ += slope_ * h * h;
  else
    unmeasured_ += h * h;
  if (has_penetration_)
    penetration_ += penetration_error_ * h;
  else
    unmeasured_time_ += h;
  if (until_measurement_ > 0)
    --until_measurement_;
}

void ErrorControl::measure_steps(const double h, const Forces &forces, const Forces &of_one_step) {
  const double error = distance(forces, of_one_step), slope = error / h;
  ++n_measurements_;
  if (!has_slope_)
    steps_ += slope * unmeasured_;
  const bool is_steady = has_slope_ && slope < 2. * slope_ && slope > 0.5 * slope_;
  interval_ = is_steady ? std::min(2 * interval_, longest_interval) : shortest_interval;
  until_measurement_ = interval_;
  slope_ = slope;
  has_slope_ = true;
  if (tolerances_.steps == 0.)
    return;
  const double spent = work_ > 0. ? steps_ / work_ : 0.;
  const double allowed = tolerances_.steps * leeway(spent, tolerances_.steps) * force_scale();
  constexpr double least = 0.2, most = 2.; // of the change at once
  const double factor = error > 0. ? allowed / error : most;
  longest_step_ = h * std::max(least, std::min(most, factor));
}

void ErrorControl::measure_penetration(const double penetration, const Forces &forces,
                                       const Forces &without) {
  penetration_error_ = distance(forces, without);
  if (!has_penetration_)
    penetration_ += penetration_error_ * unmeasured_time_;
  has_penetration_ = true;
  if (tolerances_.penetration == 0. || !(penetration_error_ > 0.))
    return;
  const double spent = work_ > 0. ? penetration_ / work_ : 0.;
  const double allowed = tolerances_.penetration * leeway(spent, tolerances_.penetration) * force_scale();
  // In proportion; tighter than what is the tightest is not to be had.
  penetration_allowed_ = std::max(1., penetration * allowed / penetration_error_);
}

void ErrorControl::miss_measurement() { until_measurement_ = shortest_interval; }

ErrorControl::Estimate ErrorControl::estimate() const {
  if (!(work_ > 0.))
    return {};
  return {steps_ / work_, penetration_ / work_, iterations_ / work_};
}

void ErrorControl::save(StateWriter &writer) const {
  writer.write("errors",
               {time_, last_force_, work_, steps_, penetration_, iterations_, slope_, penetration_error_,
                unmeasured_, unmeasured_time_, has_slope_ ? 1. : 0., has_penetration_ ? 1. : 0.,
                static_cast<double>(until_measurement_), static_cast<double>(interval_),
                static_cast<double>(n_measurements_), longest_step_, penetration_allowed_});
}

void ErrorControl::load(const StateReader &reader) {
  const std::vector<double> state = reader.read("errors");
  time_ = state.at(0);
  last_force_ = state.at(1);
  work_ = state.at(2);
  steps_ = state.at(3);
  penetration_ = state.at(4);
  iterations_ = state.at(5);
  slope_ = state.at(6);
  penetration_error_ = state.at(7);
  unmeasured_ = state.at(8);
  unmeasured_time_ = state.at(9);
  has_slope_ = state.at(10) > 0.;
  has_penetration_ = state.at(11) > 0.;
  until_measurement_ = static_cast<unsigned int>(state.at(12));
  interval_ = static_cast<unsigned int>(state.at(13));
  n_measurements_ = static_cast<unsigned int>(state.at(14));
  longest_step_ = state.at(15);
  penetration_allowed_ = state.at(16);
}

} // namespace billet
