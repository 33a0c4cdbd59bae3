// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/force_course.h"

namespace billet {

namespace {

/// Limits of the extrapolation of forces.
struct ForceCourseLimits {
  /// Maximum growth of forces until the end by extrapolation, over the force now. The rate of the
  /// last step may be that of a single event.
  static constexpr double max_growth = 10.;
};

} // namespace

void ForceCourse::accept(const double h, const double force) {
  work_ += 0.5 * (force_ + force) * h;
  time_ += h;
  force_rate_ = (force - force_) / h;
  force_ = force;
}

double ForceCourse::scale() const {
  return std::max({force_, time_ > start_ ? work_ / (time_ - start_) : 0.,
                   force_ + std::min(0.5 * force_rate_ * left(), ForceCourseLimits::max_growth * force_)});
}

void ForceCourse::save(StateWriter &writer) const {
  writer.write("course of forces", {start_, time_, force_, force_rate_, work_});
}

void ForceCourse::load(const StateReader &reader) {
  const std::vector<double> numbers = reader.read("course of forces", 5);
  RowReader row(numbers);
  for (double *number : {&start_, &time_, &force_, &force_rate_, &work_})
    *number = row.number();
}

} // namespace billet
