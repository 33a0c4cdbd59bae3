// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/penetration_errors.h"

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

/// Returns what the stiffness of bodies is in proportion to under this force, as between two
/// spheres by Hertz. It is between bodies that touch fully, with none, and those whose contact
/// spreads faster.
double stiffness_under(const double force) { return std::cbrt(force); }

} // namespace

void PenetrationErrors::accept(const double h, const double force, const double penetration) {
  const double shift = penetration * stiffness_under(force) * h;
  integral_ += slope_ * shift;
  unmeasured_ += shift;
  interval_.count_step();
}

void PenetrationErrors::measure(const ForceCourse &course, const double penetration,
                                const ResultGroup &forces, const ResultGroup &without,
                                const double residuals) {
  const double force = course.size_of(forces), noise = residuals * force,
               error = std::max(0., distance_of(forces, without) - noise);
  if (!(force > 0. && penetration > 0.)) {
    miss(false);
    return;
  }
  const bool is_first = !is_measured_;
  is_measured_ = true;
  const double last_slope = slope_;
  slope_ = error / (stiffness_under(force) * penetration);
  // Steps since the last measurement use the geometric mean of both slopes.
  // Less than nothing is round-off.
  integral_ = std::max(0., integral_ + ((is_first ? slope_ : std::sqrt(last_slope * slope_)) - last_slope) *
                                           unmeasured_);
  unmeasured_ = 0.;
  if (error <= MeasurementInterval::little * tolerance_ * force)
    interval_.start(MeasurementInterval::max);
  else if (!is_first && MeasurementInterval::is_steady(slope_, last_slope))
    interval_.start_longer();
  else
    interval_.start(MeasurementInterval::min);
  if (tolerance_ == 0. || !(error > 0.))
    return;
  // The error is proportional to penetration; the smallest tolerance is the lower limit.
  allowed_ = penetration * tolerance_ * std::max(course.scale(), force) / error;
}

void PenetrationErrors::save(StateWriter &writer) const {
  std::vector<double> numbers;
  RowWriter(numbers)
      .number(integral_)
      .number(slope_)
      .number(unmeasured_)
      .number(is_measured_ ? 1. : 0.)
      .number(allowed_)
      .number(interval_.until())
      .number(interval_.length());
  writer.write("errors of penetrations", numbers);
}

void PenetrationErrors::load(const StateReader &reader) {
  const std::vector<double> numbers = reader.read("errors of penetrations", 7);
  RowReader row(numbers);
  for (double *number : {&integral_, &slope_, &unmeasured_})
    *number = row.number();
  is_measured_ = row.flag();
  allowed_ = row.number();
  const unsigned int until = to_count(row.number());
  interval_.load(until, to_count(row.number()));
}

} // namespace billet
