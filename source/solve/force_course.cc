// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/force_course.h"

namespace billet {

void ForceCourse::accept(const double h, const double force) {
  work_ += 0.5 * (force_ + force) * h;
  time_ += h;
  force_rate_ = (force - force_) / h;
  force_ = force;
}

double ForceCourse::scale() const {
  constexpr double max_growth = 10.; // limit of the growth until the end
  return std::max({force_, time_ > start_ ? work_ / (time_ - start_) : 0.,
                   force_ + std::min(0.5 * force_rate_ * left(), max_growth * force_)});
}

void ForceCourse::save(std::vector<double> &numbers) const {
  numbers[0] = start_;
  numbers[1] = time_;
  numbers[2] = force_;
  numbers[3] = force_rate_;
  numbers[6] = work_;
}

void ForceCourse::load(const std::vector<double> &numbers) {
  start_ = numbers[0];
  time_ = numbers[1];
  force_ = numbers[2];
  force_rate_ = numbers[3];
  work_ = numbers[6];
}

} // namespace billet
