// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/error_control.h"

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

double product(const ErrorControl::Forces &a, const ErrorControl::Forces &b) {
  double sum = 0.;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += a[i] * b[i];
  return sum;
}

/// Rules of error control; factors unless they say otherwise.
struct Rules {
  /// Steps between measurements, at least: with fewer they cost more than they save, and no target was missed
  /// for that. Where one was not possible, the next step may be the occasion.
  static constexpr unsigned int min_interval = 4, soon = 1;
  /// Errors neither grow nor fade, on the whole: in upsetting they grow with the force, in stretching they
  /// fade. This is what the first makes of them.
  static constexpr double growth_of_errors = 1.4;
  /// Sum of 1, 1/2, 1/4, ...: of errors that fade by half in each pair of steps.
  static constexpr double sum_of_halves = 2.;
  /// Growth of forces until the end that counts, at most.
  static constexpr double max_growth_of_forces = 10.;
  /// Least part of the span that is left for errors to grow in.
  static constexpr double min_left = 1e-3;
  /// Of an even rate of errors. Forces may be others by the end: nothing is saved at any price, nor spent at
  /// once. What is spent late adds little, which is true of what is saved, too.
  static constexpr double min_rate = 0.2, max_rate = 6.;
  /// By which steps may become shorter or longer at once.
  static constexpr double min_stretch = 0.5, max_stretch = 4.;
  /// Of the slope of errors from one measurement to the next: what is above happens once.
  static constexpr double max_sudden = 3.;
  /// Between two slopes that are steady.
  static constexpr double steady = 2.;
  /// Part of the target below which errors are little: measurements become rare.
  static constexpr double little = 0.1;
  /// Part of the target from which on steps matter at all: then they are not longer than `max_span` times the
  /// root of the tolerance in spans of the run, so that slopes do not change beyond recognition between two
  /// measurements; nor made shorter than `min_span` times the tolerance, so that what happens once in a
  /// while, whatever the step, does not decide.
  static constexpr double matters = 0.05, max_span = 0.65, min_span = 3.;
  /// Steps that are `shorter` than the last ones, and err `as_much` in the same time, are of no use: where
  /// nodes touch, or begin to slip, one by one.
  static constexpr double shorter = 0.75, as_much = 0.8;
  /// Of a step after which comparisons fail twice in a row.
  static constexpr double cut = 0.5;
};

/// What is left of the forces by steps of length h of which each pair makes 2 c h², in parts of c, and
/// forgets half of what was: the sum of 1, ½, ¼, ...
double left_where_errors_fade(const double h) { return Rules::sum_of_halves * 2. * h * h; }

} // namespace

double ErrorControl::size(const Forces &forces) {
  double sum = 0.;
  for (const auto &force : forces)
    sum += force.norm();
  return sum;
}

double ErrorControl::distance(const Forces &a, const Forces &b) {
  double sum = 0.;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += (a[i] - b[i]).norm();
  return sum;
}

double ErrorControl::force_scale() const {
  // What it is, has been, or will be in the mean if it goes on like this.
  const double left = std::max(0., end_time_ - time_);
  return std::max(
      {last_force_, time_ > start_ ? work_ / (time_ - start_) : 0.,
       last_force_ + std::min(0.5 * force_rate_ * left, Rules::max_growth_of_forces * last_force_)});
}

void ErrorControl::add_step_errors(const double h) {
  errors_.resize(slopes_.size()); // after a restart there may be other tools
  for (std::size_t i = 0; i < errors_.size(); ++i)
    errors_[i] = tolerances_.fade ? left_where_errors_fade(h) * slopes_[i]
                                  : errors_[i] + Rules::growth_of_errors * h * h * slopes_[i];
}

void ErrorControl::accept(const double h, const Forces &forces, const double residual,
                          const double penetration) {
  const double force = size(forces);
  work_ += 0.5 * (last_force_ + force) * h;
  time_ += h;
  if (n_measurements_ == 0 && !has_given_up() && tolerances_.steps > 0.) // what steps make is not known yet
    longest_step_ = std::min(longest_step_, h);
  force_rate_ = (force - last_force_) / h;
  last_force_ = force;
  iterations_ += residual * force * h;
  if (slopes_.size() == forces.size())
    add_step_errors(h);
  unmeasured_ += h * h;
  unmeasured_span_ += h;
  const double error = size(errors_);
  steps_ += 0.5 * (last_error_ + error) * h;
  last_error_ = error;
  penetration_ += penetration_slope_ * penetration * force * h;
  unmeasured_penetration_ += penetration * force * h;
  if (until_measurement_ > 0)
    --until_measurement_;
  if (until_penetration_ > 0)
    --until_penetration_;
}

double ErrorControl::allowed_rate() const {
  // If the errors of forces grew from e at a rate r until the end, with forces as they are,
  //   ∫ e dt = I + e t' + ½ r t'²,   ∫ Σ|F| dt = W + S t',   t' what is left of the time.
  const double left = std::max(end_time_ - time_, Rules::min_left * (end_time_ - start_)),
               scale = force_scale();
  const double rate =
      2. * (tolerances_.steps * (work_ + scale * left) - steps_ - last_error_ * left) / (left * left);
  const double span = end_time_ - start_, even = 2. * tolerances_.steps * scale / span;
  return std::min(Rules::max_rate * even,
                  std::max(Rules::min_rate * even * span * span / (left * left), rate));
}

double ErrorControl::left_at_the_end(const double slope, const double h) const {
  return tolerances_.fade ? left_where_errors_fade(h) * slope
                          : Rules::growth_of_errors * slope * h * (end_time_ - start_);
}

double ErrorControl::allowed_stretch(const double h) const {
  if (!(last_slope_ > 0.))
    return Rules::max_stretch;
  const double stretch = tolerances_.fade
                             ? std::sqrt(tolerances_.steps * force_scale() / left_at_the_end(last_slope_, h))
                             : allowed_rate() / (Rules::growth_of_errors * last_slope_ * h);
  return std::clamp(stretch, Rules::min_stretch, Rules::max_stretch);
}

void ErrorControl::measure_steps(const double h, const Forces &forces, const Forces &of_one_step,
                                 const double residuals) {
  const bool is_first = slopes_.size() != forces.size();
  const double difference = distance(of_one_step, forces), noise = residuals * size(forces);
  // Between what the difference is with and without the noise: as it was last time, if that is in between.
  const double least_slope = std::max(0., difference - noise) / (2. * h * h),
               most_slope = (difference + noise) / (2. * h * h);
  const double slope = is_first ? least_slope : std::max(least_slope, std::min(last_slope_, most_slope)),
               last_slope = is_first ? slope : last_slope_;
  // Of differences within the noise not even the direction is known.
  Forces now = difference > noise || is_first ? forces : slopes_;
  if (difference > noise || is_first)
    for (std::size_t i = 0; i < forces.size(); ++i)
      now[i] = difference > 0. ? slope / difference * (of_one_step[i] - forces[i]) : Force();
  else if (last_slope_ > 0.)
    for (auto &part : now)
      part *= slope / last_slope_;
  // So far steps since the last measurement count with c from there. Those that were measured now are known,
  // and those between have something in between: the geometric mean, so that what happens once, such as a
  // node that begins to slip, does not count for all.
  const double between = !(slope > 0.)                             ? 0.
                         : tolerances_.stays && last_slope < slope ? 1.
                                                                   : std::sqrt(last_slope / slope);
  const double h_squared = unmeasured_ - 2. * h * h;
  slopes_.resize(forces.size());
  errors_.resize(forces.size());
  for (std::size_t i = 0; i < forces.size(); ++i)
    errors_[i] = tolerances_.fade ? left_where_errors_fade(h) * now[i]
                                  : errors_[i] + Rules::growth_of_errors *
                                                     (2. * h * h * now[i] + h_squared * between * now[i] -
                                                      unmeasured_ * slopes_[i]);
  const double error = size(errors_);
  steps_ += 0.5 * (error - last_error_) * unmeasured_span_;
  last_error_ = error;
  // From here on this, unless it is much more than last time, for the same reason. Errors that turn around do
  // not add up.
  const double sudden = slope > Rules::max_sudden * last_slope && !tolerances_.stays
                            ? Rules::max_sudden * last_slope / slope
                            : 1.;
  const bool has_turned = product(now, slopes_) < 0.;
  for (std::size_t i = 0; i < forces.size(); ++i)
    slopes_[i] = has_turned ? 0.5 * (slopes_[i] + sudden * now[i]) : sudden * now[i];
  last_slope_ = size(slopes_);
  unmeasured_ = unmeasured_span_ = 0.;
  const double last_step = measured_step_, last_part = part_;
  measured_step_ = h;
  const double force = size(forces); // 0 of a tool that has not moved yet, while others have
  part_ = force > 0. ? difference / (h * force) : 0.;
  ++n_measurements_;
  n_failed_ = 0;
  const bool is_steady =
      slope <= Rules::steady * last_slope && slope >= last_slope / Rules::steady && !is_first;
  const double rough_target = tolerances_.fade ? tolerances_.steps : 2. * tolerances_.steps;
  is_little_ = left_at_the_end(most_slope, h) <= Rules::little * rough_target * force_scale();
  interval_ = is_steady || is_little_ ? std::clamp(2 * interval_, Rules::min_interval, longest_interval)
                                      : Rules::min_interval;
  until_measurement_ = interval_;
  if (tolerances_.steps == 0.)
    return;
  const bool may_matter = left_at_the_end(most_slope, h) > Rules::matters * rough_target * force_scale();
  choose_longest_step(h, may_matter && !tolerances_.fade, difference > noise);
  if (h < Rules::shorter * last_step && part_ > Rules::as_much * last_part)
    longest_step_ = std::max(longest_step_, last_step);
}

void ErrorControl::choose_longest_step(const double h, const bool matter, const bool is_known) {
  longest_step_ = h * allowed_stretch(h);
  if (!matter)
    return;
  const double span = end_time_ - start_, most_span = Rules::max_span * std::sqrt(tolerances_.steps) * span;
  longest_step_ = std::min(longest_step_, is_known ? most_span : std::max(most_span, h));
  if (longest_step_ < h)
    longest_step_ = std::max(
        longest_step_, std::min(h, std::min(0.5 * most_span, Rules::min_span * tolerances_.steps * span)));
}

void ErrorControl::measure_penetration(const double penetration, const Forces &forces, const Forces &without,
                                       const double residuals) {
  const double force = size(forces), noise = residuals * force,
               error = std::max(0., distance(forces, without) - noise);
  if (!(force > 0. && penetration > 0.)) {
    miss_penetration(false);
    return;
  }
  const bool is_first = !has_penetration_;
  has_penetration_ = true;
  const double last_slope = penetration_slope_;
  penetration_slope_ = error / (force * penetration);
  // Steps since the last measurement have something in between.
  penetration_ +=
      ((is_first ? penetration_slope_ : std::sqrt(last_slope * penetration_slope_)) - last_slope) *
      unmeasured_penetration_;
  unmeasured_penetration_ = 0.;
  const bool is_steady = !is_first && penetration_slope_ <= Rules::steady * last_slope &&
                         penetration_slope_ >= last_slope / Rules::steady;
  const bool is_little = error <= Rules::little * tolerances_.penetration * force;
  penetration_interval_ = is_little ? longest_interval
                          : is_steady
                              ? std::clamp(2 * penetration_interval_, Rules::min_interval, longest_interval)
                              : Rules::min_interval;
  until_penetration_ = penetration_interval_;
  if (tolerances_.penetration == 0. || !(error > 0.))
    return;
  // In proportion; tighter than what is the tightest is not to be had.
  const double allowed = most_over_mean * tolerances_.penetration * std::max(force_scale(), force);
  penetration_allowed_ = std::max(1., penetration * allowed / error);
}

void ErrorControl::miss_measurement(const double h, const bool failed) {
  if (failed && is_little_ && !tolerances_.stays) { // nothing is gained by shorter ones
    until_measurement_ = interval_;
    return;
  }
  n_failed_ = failed ? n_failed_ + 1 : 0;
  until_measurement_ = Rules::soon;
  // Something may just have happened there; twice in a row it is the length; and where shorter ones fail like
  // longer ones it is neither.
  if (has_given_up()) {
    until_measurement_ = longest_interval;
    longest_step_ = std::numeric_limits<double>::infinity();
  } else if (n_failed_ > 1 && tolerances_.steps > 0.)
    longest_step_ = std::min(longest_step_, Rules::cut * h);
}

ErrorControl::Estimate ErrorControl::estimate() const {
  if (!(work_ > 0.))
    return {};
  return {steps_ / work_, penetration_ / work_, iterations_ / work_};
}

void ErrorControl::save(StateWriter &writer, const std::string &name, const Forces &forces) {
  std::vector<double> numbers;
  for (const auto &force : forces)
    numbers.insert(numbers.end(), force.begin_raw(), force.end_raw());
  writer.write(name, numbers);
}

ErrorControl::Forces ErrorControl::load(const StateReader &reader, const std::string &name) {
  const std::vector<double> numbers = reader.read(name);
  Forces forces;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    forces.push_back(Force({numbers[i], numbers[i + 1], numbers[i + 2]}));
  return forces;
}

void ErrorControl::save(StateWriter &writer) const {
  writer.write("errors", {start_,
                          time_,
                          last_force_,
                          force_rate_,
                          last_slope_,
                          last_error_,
                          work_,
                          steps_,
                          penetration_,
                          iterations_,
                          penetration_slope_,
                          unmeasured_,
                          unmeasured_span_,
                          unmeasured_penetration_,
                          measured_step_,
                          has_penetration_ ? 1. : 0.,
                          static_cast<double>(until_measurement_),
                          static_cast<double>(interval_),
                          static_cast<double>(n_measurements_),
                          longest_step_,
                          penetration_allowed_,
                          static_cast<double>(until_penetration_),
                          static_cast<double>(penetration_interval_),
                          is_little_ ? 1. : 0.,
                          part_,
                          static_cast<double>(n_failed_)});
  save(writer, "errors by steps", slopes_);
  save(writer, "errors of forces", errors_);
}

void ErrorControl::load(const StateReader &reader) {
  const std::vector<double> state = reader.read("errors");
  start_ = state.at(0);
  time_ = state.at(1);
  last_force_ = state.at(2);
  force_rate_ = state.at(3);
  last_slope_ = state.at(4);
  last_error_ = state.at(5);
  work_ = state.at(6);
  steps_ = state.at(7);
  penetration_ = state.at(8);
  iterations_ = state.at(9);
  penetration_slope_ = state.at(10);
  unmeasured_ = state.at(11);
  unmeasured_span_ = state.at(12);
  unmeasured_penetration_ = state.at(13);
  measured_step_ = state.at(14);
  has_penetration_ = state.at(15) > 0.;
  until_measurement_ = static_cast<unsigned int>(state.at(16));
  interval_ = static_cast<unsigned int>(state.at(17));
  n_measurements_ = static_cast<unsigned int>(state.at(18));
  longest_step_ = state.at(19);
  penetration_allowed_ = state.at(20);
  until_penetration_ = static_cast<unsigned int>(state.at(21));
  penetration_interval_ = static_cast<unsigned int>(state.at(22));
  is_little_ = state.at(23) > 0.;
  part_ = state.at(24);
  n_failed_ = state.size() > 25 ? static_cast<unsigned int>(state[25]) : 0;
  slopes_ = load(reader, "errors by steps");
  errors_ = load(reader, "errors of forces");
}

} // namespace billet
