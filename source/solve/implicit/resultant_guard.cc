// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/resultant_guard.h"

#include "billet/discretization/body_volumes.h"
#include "billet/solve/unbalanced_bodies.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

struct Limits {
  /// Maximum number of failures in a row that count; each beyond the first doubles the number of steps
  /// without a trial, and adds one.
  static constexpr unsigned int max_failures = 7;
};

/// First number of moments on a body.
constexpr std::size_t of_moments = 6;

} // namespace

ResultantGuard::ResultantGuard(const ImplicitProblem &problem)
    : problem_(problem), reactions_(problem),
      round_off_(UnbalancedBodies::find_round_off(parts_.scene(), parts_.discretization())),
      largest_(parts_.scene().bodies().size(), OfBody{}), trial_(largest_) {
  for (const NamedSupport &support : named_supports(parts_.scene()))
    bodies_of_supports_.push_back(support.body);
  for (const double volume : measure_body_volumes(parts_.discretization()))
    sizes_.push_back(std::cbrt(volume));
}

double ResultantGuard::find_part() {
  reactions_.start();
  const Reactions &reactions = reactions_.values();
  trial_ = largest_;
  for (std::size_t s = 0; s < bodies_of_supports_.size(); ++s)
    count(bodies_of_supports_[s], reactions.of_supports[s].force, reactions.of_supports[s].moment);
  for (const auto &contact : parts_.contacts()) {
    ContactLoad load = contact.measures().compute_load();
    if (const auto &tool = contact.rigid_tool())
      load = about_origin(load,
                          parts_.tools().place(*tool, problem_.step().time, parts_.tools().offsets()[*tool]));
    for (const std::size_t body : contact.bodies())
      count(body, load.force, load.moment);
  }
  double part = 0.;
  for (std::size_t b = 0; b < trial_.size(); ++b) {
    const BodyBalance &forces = reactions.of_bodies[b];
    const BodyMoments &moments = reactions_.moments()[b];
    for (unsigned int i = 0; i < 3; ++i) {
      trial_[b][3 + i] = std::max(trial_[b][3 + i], forces.nodal);
      trial_[b][of_moments + 3 + i] = std::max(trial_[b][of_moments + 3 + i], moments.nodal[i]);
    }
    part = std::max({part, find_part(b, forces.free, round_off_[b], 0),
                     find_part(b, moments.free, round_off_[b] * sizes_[b], of_moments)});
  }
  return part;
}

void ResultantGuard::count(const std::size_t body, const Tensor<1, 3> &force, const Tensor<1, 3> &moment) {
  const Tensor<1, 3> about_centre = moment_about(reactions_.moments()[body].centre, moment, force);
  for (unsigned int i = 0; i < 3; ++i) {
    trial_[body][i] = std::max(trial_[body][i], std::abs(force[i]));
    trial_[body][of_moments + i] = std::max(trial_[body][of_moments + i], std::abs(about_centre[i]));
  }
}

double ResultantGuard::find_part(const std::size_t body, const Tensor<1, 3> &free, const double round_off,
                                 const std::size_t first) const {
  const OfBody &of_body = trial_[body];
  double part = 0.;
  for (unsigned int i = 0; i < 3; ++i) {
    const double largest = of_body[first + i], nodal = of_body[first + 3 + i];
    if (largest > UnbalancedBodies::least_force(round_off, nodal, parts_.parameters().solver))
      part = std::max(part, std::abs(free[i]) / largest);
  }
  return part;
}

void ResultantGuard::commit() {
  largest_ = trial_;
  if (n_left_out_ > 0) {
    --n_left_out_;
    return;
  }
  n_failed_ = has_failed_ ? std::min(n_failed_ + 1, Limits::max_failures) : 0;
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
  constexpr std::size_t of_body = std::tuple_size<OfBody>::value;
  if (numbers.size() != 2 + of_body * largest_.size())
    return; // saved for other bodies
  n_failed_ = static_cast<unsigned int>(numbers[0]);
  n_left_out_ = static_cast<unsigned int>(numbers[1]);
  for (std::size_t b = 0; b < largest_.size(); ++b)
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(2 + of_body * b), of_body, largest_[b].begin());
  trial_ = largest_;
}

} // namespace billet
