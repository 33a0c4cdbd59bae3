// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/step_errors.h"

#include "billet/times.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace billet {

namespace {

double product(const ResultGroup &a, const ResultGroup &b) {
  double sum = 0.;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += a[i] * b[i];
  return sum;
}

/// Constants of error control; factors unless they say otherwise.
struct StepErrorFactors {
  /// Steps until the next measurement after an impossible one.
  static constexpr unsigned int soon = 1;
  /// Growth of errors: they grow with the force in upsetting, and fade in stretching. This is the
  /// value for upsetting.
  static constexpr double growth_of_errors = 1.4;
  /// Sum of 1, 1/2, 1/4, ...: of errors that fade by half in each pair of steps.
  static constexpr double sum_of_halves = 2.;
  /// Limits of the error rate, as factors of an even rate. The minimum also grows with
  /// (span / left)², since errors late in the run add little to the integral. Forces may change
  /// until the end, so the allowance is neither saved at any cost nor spent at once.
  static constexpr double min_rate = 0.2, max_rate = 6.;
  /// Minimum and maximum factor of a change of the step.
  static constexpr double min_stretch = 0.5, max_stretch = 4.;
  /// Maximum growth of the slope between measurements; a larger one is a single event.
  static constexpr double max_sudden = 3.;
  /// Part of the target from which on steps matter. Then they are at most `max_span` times the root
  /// of the tolerance in spans of the run, so that slopes stay comparable between measurements.
  /// They are not cut below `min_span` times the tolerance, so that rare events, which do not
  /// depend on the step, do not decide.
  static constexpr double matters = 0.05, max_span = 0.65, min_span = 3.;
  /// Steps that are `shorter` than the last ones, but cause `as_much` error in the same time, are
  /// useless. Then nodes touch, or begin to slip, one by one.
  static constexpr double shorter = 0.75, as_much = 0.8;
  /// Minimum step after a measurement, over the maximum that `max_span` gives.
  static constexpr double min_of_max_span = 0.5;
  /// Factor of a step at which comparisons fail twice in a row.
  static constexpr double cut = 0.5;
  /// Steps that are `longer` than the measured ones are measured anew.
  static constexpr double longer = 1.5;
  /// Remaining steps below which the first comparison cannot wait: it takes two, and one more would
  /// be taken before it.
  static constexpr double last_chance = 3.;
};

/// Returns the error of forces, in units of c, by steps of length h. Each pair of steps adds 2 c h²
/// and halves the earlier error: the sum of 1, ½, ¼, ...
double left_where_errors_fade(const double h) { return StepErrorFactors::sum_of_halves * 2. * h * h; }

} // namespace

void StepErrors::add_step(const double h) {
  errors_.resize(slopes_.size()); // after a restart there may be other tools
  for (std::size_t i = 0; i < errors_.size(); ++i)
    errors_[i] = rules_.fade ? left_where_errors_fade(h) * slopes_[i]
                             : errors_[i] + StepErrorFactors::growth_of_errors * h * h * slopes_[i];
}

void StepErrors::accept(const double h, const std::size_t n_forces) {
  longest_taken_ = std::max(longest_taken_, h);
  // The error of steps is not known yet.
  if (n_measurements_ == 0 && !has_given_up() && rules_.tolerance > 0.)
    longest_step_ = std::min(longest_step_, h);
  if (slopes_.size() == n_forces)
    add_step(h);
  unmeasured_ += h * h;
  unmeasured_span_ += h;
  const double error = size_of(errors_);
  integral_ += 0.5 * (last_error_ + error) * h;
  last_error_ = error;
  interval_.count_step();
}

bool StepErrors::wants_measurement(const ForceCourse &course, const double h) const {
  if (n_measurements_ == 0 &&
      times::is_after(course.time() + StepErrorFactors::last_chance * h, course.end_time()))
    return true;
  return wants_measurement(course) ||
         (n_measurements_ > 0 && course.force() > 0. && h > StepErrorFactors::longer * measured_step_);
}

double StepErrors::allowed_rate(const ForceCourse &course) const {
  // If the errors of forces grew from e at a rate r until the end, with forces as they are,
  //   ∫ e dt = I + e t' + ½ r t'²,   ∫ Σ|F| dt = W + S t',   t' what is left of the time.
  const double span = course.span(), left = course.end_time() - course.time(), scale = course.scale();
  const double even = 2. * rules_.tolerance * scale / span;
  // Then the minimum is the maximum.
  if (!(StepErrorFactors::min_rate * span * span < StepErrorFactors::max_rate * left * left))
    return StepErrorFactors::max_rate * even;
  const double rate = 2. *
                      (rules_.tolerance * (course.work() + scale * left) - integral_ - last_error_ * left) /
                      (left * left);
  return std::min(StepErrorFactors::max_rate * even,
                  std::max(StepErrorFactors::min_rate * even * span * span / (left * left), rate));
}

double StepErrors::left_at_the_end(const ForceCourse &course, const double slope, const double h) const {
  return rules_.fade ? left_where_errors_fade(h) * slope
                     : StepErrorFactors::growth_of_errors * slope * h * course.span();
}

double StepErrors::allowed_stretch(const ForceCourse &course, const double h) const {
  if (!(last_slope_ > 0.))
    return StepErrorFactors::max_stretch;
  const double stretch =
      rules_.fade ? std::sqrt(rules_.tolerance * course.scale() / left_at_the_end(course, last_slope_, h))
                  : allowed_rate(course) / (StepErrorFactors::growth_of_errors * last_slope_ * h);
  return std::clamp(stretch, StepErrorFactors::min_stretch, StepErrorFactors::max_stretch);
}

StepErrors::Slope StepErrors::slope_of(const double h, const ResultGroup &forces,
                                       const ResultGroup &of_one_step, const double difference,
                                       const double noise) const {
  const bool is_first = slopes_.size() != forces.size();
  // The slope lies between the differences with and without noise: keep the last value if it is
  // between them.
  const double min_slope = std::max(0., difference - noise) / (2. * h * h),
               max_slope = (difference + noise) / (2. * h * h);
  const double value = is_first ? min_slope : std::max(min_slope, std::min(last_slope_, max_slope)),
               last = is_first ? value : last_slope_;
  // If the difference is within the noise, not even its direction is known.
  ResultGroup now = difference > noise || is_first ? forces : slopes_;
  if (difference > noise || is_first)
    for (std::size_t i = 0; i < forces.size(); ++i)
      now[i] = difference > 0. ? value / difference * (of_one_step[i] - forces[i]) : dealii::Tensor<1, 3>();
  else if (last_slope_ > 0.)
    for (auto &part : now)
      part *= value / last_slope_;
  return {value, last, max_slope, is_first, difference > noise, std::move(now)};
}

void StepErrors::take(const Slope &slope, const double h) {
  const ResultGroup &now = slope.now;
  // Steps since the last measurement have counted with its c so far. The measured steps are known
  // now; those before use the geometric mean. Thus a single event, such as a node that begins to
  // slip, does not count for all.
  const double between = !(slope.value > 0.)                        ? 0.
                         : rules_.stays && slope.last < slope.value ? 1.
                                                                    : std::sqrt(slope.last / slope.value);
  const double h_squared = unmeasured_ - 2. * h * h;
  slopes_.resize(now.size());
  errors_.resize(now.size());
  for (std::size_t i = 0; i < now.size(); ++i)
    errors_[i] = rules_.fade ? left_where_errors_fade(h) * now[i]
                             : errors_[i] + StepErrorFactors::growth_of_errors *
                                                (2. * h * h * now[i] + h_squared * between * now[i] -
                                                 unmeasured_ * slopes_[i]);
  const double error = size_of(errors_);
  integral_ += 0.5 * (error - last_error_) * unmeasured_span_;
  last_error_ = error;
  // From here on the new slope counts, limited if it is much larger than the last one, for the same
  // reason. Errors that change direction do not add up.
  const double sudden = slope.value > StepErrorFactors::max_sudden * slope.last && !rules_.stays
                            ? StepErrorFactors::max_sudden * slope.last / slope.value
                            : 1.;
  const bool has_turned = product(now, slopes_) < 0.;
  for (std::size_t i = 0; i < now.size(); ++i)
    slopes_[i] = has_turned ? 0.5 * (slopes_[i] + sudden * now[i]) : sudden * now[i];
  last_slope_ = size_of(slopes_);
  unmeasured_ = unmeasured_span_ = 0.;
}

void StepErrors::schedule(const ForceCourse &course, const Slope &slope, const double h) {
  is_little_ = left_at_the_end(course, slope.maximum, h) <=
               MeasurementInterval::little * rough_target() * course.scale();
  const bool is_steady = MeasurementInterval::is_steady(slope.value, slope.last) && !slope.is_first;
  if (is_steady || is_little_)
    interval_.start_longer();
  else
    interval_.start(MeasurementInterval::min);
}

void StepErrors::measure(const ForceCourse &course, const double h, const ResultGroup &forces,
                         const ResultGroup &of_one_step, const double residuals) {
  // 0 for a tool that has not moved yet, while others have.
  const double force = course.size_of(forces);
  const double difference = distance_of(of_one_step, forces);
  const Slope slope = slope_of(h, forces, of_one_step, difference, residuals * force);
  take(slope, h);
  const double last_step = measured_step_, last_part = part_;
  measured_step_ = h;
  part_ = force > 0. ? difference / (h * force) : 0.;
  ++n_measurements_;
  n_failed_ = 0;
  schedule(course, slope, h);
  if (rules_.tolerance == 0.)
    return;
  const bool may_matter =
      left_at_the_end(course, slope.maximum, h) > StepErrorFactors::matters * rough_target() * course.scale();
  choose_longest_step(course, h, may_matter && !rules_.fade, slope.is_known);
  if (h < StepErrorFactors::shorter * last_step && part_ > StepErrorFactors::as_much * last_part)
    longest_step_ = std::max(longest_step_, last_step);
}

void StepErrors::choose_longest_step(const ForceCourse &course, const double h, const bool matter,
                                     const bool is_known) {
  longest_step_ = h * allowed_stretch(course, h);
  if (!matter)
    return;
  const double span = course.span(),
               max_span = StepErrorFactors::max_span * std::sqrt(rules_.tolerance) * span;
  longest_step_ = std::min(longest_step_, is_known ? max_span : std::max(max_span, h));
  // Steps that Newton's method has cut grow again: errors do not hold them below this either.
  const double grown = std::min(longest_taken_, StepErrorFactors::max_stretch * h);
  longest_step_ = std::max(longest_step_,
                           std::min(grown, std::min(StepErrorFactors::min_of_max_span * max_span,
                                                    StepErrorFactors::min_span * rules_.tolerance * span)));
}

void StepErrors::miss(const double h, const bool failed) {
  if (failed && is_little_ && !rules_.stays) { // shorter steps bring no gain
    interval_.repeat();
    return;
  }
  n_failed_ = failed ? n_failed_ + 1 : 0;
  interval_.wait(StepErrorFactors::soon);
  // A first failure may be a single event, a second one is due to the length. If shorter steps fail
  // as well, it is neither.
  if (has_given_up()) {
    interval_.wait(MeasurementInterval::max);
    longest_step_ = std::numeric_limits<double>::infinity();
  } else if (n_failed_ > 1 && rules_.tolerance > 0.)
    longest_step_ = std::min(longest_step_, StepErrorFactors::cut * h);
}

void StepErrors::save(StateWriter &writer) const {
  std::vector<double> numbers;
  RowWriter(numbers)
      .number(last_slope_)
      .number(last_error_)
      .number(integral_)
      .number(unmeasured_)
      .number(unmeasured_span_)
      .number(measured_step_)
      .number(interval_.until())
      .number(interval_.length())
      .number(n_measurements_)
      .number(longest_step_)
      .number(is_little_ ? 1. : 0.)
      .number(part_)
      .number(n_failed_);
  writer.write("errors of steps", numbers);
  writer.write("longest step", {longest_taken_});
  billet::save(writer, "errors by steps", slopes_);
  billet::save(writer, "errors of forces", errors_);
}

void StepErrors::load(const StateReader &reader) {
  const std::vector<double> numbers = reader.read("errors of steps", 13);
  RowReader row(numbers);
  for (double *number :
       {&last_slope_, &last_error_, &integral_, &unmeasured_, &unmeasured_span_, &measured_step_})
    *number = row.number();
  const unsigned int until = to_count(row.number());
  interval_.load(until, to_count(row.number()));
  n_measurements_ = to_count(row.number());
  longest_step_ = row.number();
  is_little_ = row.flag();
  part_ = row.number();
  n_failed_ = to_count(row.number());
  longest_taken_ = reader.has("longest step") ? reader.read("longest step", 1)[0] : 0.;
  slopes_ = load_result_group(reader, "errors by steps");
  errors_ = load_result_group(reader, "errors of forces");
}

} // namespace billet
