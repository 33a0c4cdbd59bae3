// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/resultant_guard.h"

#include "billet/solve/unbalanced_bodies.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

struct ResultantGuardLimits {
  /// Maximum number of failures in a row that count; each beyond the first doubles the number of
  /// steps without a trial, and adds one.
  static constexpr unsigned int max_failures = 7;
};

} // namespace

ResultantGuard::ResultantGuard(const ImplicitProblem &problem)
    : problem_(problem), reactions_(problem),
      round_off_(UnbalancedBodies::find_round_off(parts_.scene(), parts_.discretization())),
      largest_(parts_.scene().bodies().size(), OfBody{}), trial_(largest_) {
  for (const NamedSupport &support : named_supports(parts_.scene()))
    bodies_of_supports_.push_back(support.body);
}

double ResultantGuard::find_part() {
  reactions_.start();
  const Reactions &reactions = reactions_.values();
  trial_ = largest_;
  const auto count = [this](const std::size_t body, const Tensor<1, 3> &force) {
    for (unsigned int i = 0; i < 3; ++i)
      trial_[body][i] = std::max(trial_[body][i], std::abs(force[i]));
  };
  for (std::size_t s = 0; s < bodies_of_supports_.size(); ++s)
    count(bodies_of_supports_[s], reactions.of_supports[s].force);
  for (const auto &contact : parts_.contacts()) {
    const Tensor<1, 3> force = contact.measures().compute_load().force;
    for (const std::size_t body : contact.bodies())
      count(body, force);
  }
  double part = 0.;
  for (std::size_t b = 0; b < trial_.size(); ++b) {
    trial_[b][3] = std::max(trial_[b][3], reactions.of_bodies[b].nodal);
    const double least =
        UnbalancedBodies::least_force(round_off_[b], trial_[b][3], parts_.parameters().solver);
    for (unsigned int i = 0; i < 3; ++i)
      if (trial_[b][i] > least)
        part = std::max(part, std::abs(reactions.of_bodies[b].free[i]) / trial_[b][i]);
  }
  return part;
}

void ResultantGuard::commit() {
  largest_ = trial_;
  if (n_left_out_ > 0) {
    --n_left_out_;
    return;
  }
  n_failed_ = has_failed_ ? std::min(n_failed_ + 1, ResultantGuardLimits::max_failures) : 0;
  n_left_out_ = has_failed_ ? (1U << (n_failed_ - 1)) - 1 : 0;
  has_failed_ = false;
}

void ResultantGuard::save(StateWriter &writer) const {
  std::vector<double> numbers{static_cast<double>(n_failed_), static_cast<double>(n_left_out_)};
  for (const OfBody &body : largest_)
    numbers.insert(numbers.end(), body.begin(), body.end());
  writer.write("resultants", numbers);
}

void ResultantGuard::load(StateReader &reader) {
  if (!reader.has("resultants"))
    return;
  const std::vector<double> numbers = reader.read("resultants");
  if (numbers.size() != 2 + 4 * largest_.size())
    return; // saved for other bodies
  n_failed_ = to_count(numbers[0]);
  n_left_out_ = to_count(numbers[1]);
  for (std::size_t b = 0; b < largest_.size(); ++b)
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(2 + 4 * b), 4, largest_[b].begin());
  trial_ = largest_;
}

} // namespace billet
