// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/body_levels.h"

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

/// Part of a body's equal share of the target below which its mesh stays, (W7). A body's estimate
/// may be a third of its error (doc/results/mesh-error.md), and the others are to have most of the
/// target.
constexpr double small_part = 0.25;
/// Orders of convergence that count. Lower ones are none; higher ones are chance.
constexpr double lowest_order = 0.5, highest_order = 2.;
/// Safety of an observed order: Roache's grid convergence index of three meshes, (W6). An assumed
/// order is safe by itself.
constexpr double safety = 1.25;
constexpr double in_three_directions = 8.; // growth of elements

/// Returns the order that estimates (W5) of a mesh and of the next finer one show, at least 1, that
/// of contact.
double expected_order(const double before, const double now) {
  return before > 0. && now > 0. ? std::clamp(std::log2(before / now), 1., highest_order) : 1.;
}

double sum_of(const std::vector<BodyMesh> &bodies) {
  double sum = 0.;
  for (const BodyMesh &body : bodies)
    sum += body.error;
  return sum;
}

} // namespace

MeshLevelError extrapolate(const std::vector<double> &differences, const double expected_order) {
  MeshLevelError result;
  const double last = differences.back();
  double factor = 1.;
  if (differences.size() < 2) {
    result.order = expected_order;
  } else {
    factor = safety;
    const double before = differences[differences.size() - 2];
    if (!(before > std::exp2(lowest_order) * last)) {
      result.error = std::max(before, last);
      result.is_known = before == 0. && last == 0.;
      return result;
    }
    result.order = last > 0. ? std::min(highest_order, std::log2(before / last)) : highest_order;
  }
  result.error = factor * last / (std::exp2(result.order) - 1.);
  return result;
}

BodyLevels::BodyLevels(const std::size_t n_bodies, const int first, const double target)
    : target_(target), level_(first), levels_(n_bodies, first), has_risen_(n_bodies, true),
      errors_(n_bodies, 0.), growths_(n_bodies, in_three_directions) {}

void BodyLevels::add(const double difference, const std::vector<BodyMesh> &bodies) {
  const double estimate_before = sum_of(bodies_);
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (has_risen_[b])
      growths_[b] = static_cast<double>(bodies[b].n_elements) / static_cast<double>(bodies_[b].n_elements);
  bodies_ = bodies;
  ++n_runs_;
  const bool is_resolved =
      std::all_of(bodies.begin(), bodies.end(), [](const BodyMesh &body) { return body.is_resolved; });
  n_resolved_ = is_resolved ? n_resolved_ + 1 : 0;
  if (n_runs_ == 1)
    return;
  MeshLevelError of_risen = n_resolved_ < 3
                                ? extrapolate({difference}, expected_order(estimate_before, sum_of(bodies)))
                                : extrapolate({difference_, difference});
  // A single element across is no coarser mesh of several.
  of_risen.is_known = of_risen.is_known && n_resolved_ > 1;
  difference_ = difference;
  double sum = 0., n_risen = 0.;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (has_risen_[b]) {
      sum += bodies[b].error;
      n_risen += 1.;
    }
  error_ = of_risen;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (has_risen_[b])
      errors_[b] = of_risen.error * (sum > 0. ? bodies[b].error / sum : 1. / n_risen);
    else
      error_.error += errors_[b];
}

std::vector<bool> BodyLevels::find_rising() const {
  if (!has_error() || !error_.is_known)
    return has_risen_;
  const double enough = small_part * target_ / static_cast<double>(levels_.size());
  std::vector<bool> rises(levels_.size());
  for (std::size_t b = 0; b < rises.size(); ++b)
    rises[b] = has_risen_[b] && (errors_[b] > enough || levels_[b] < 0);
  return std::find(rises.begin(), rises.end(), true) == rises.end() ? has_risen_ : rises;
}

double BodyLevels::growth(const unsigned int n) const {
  const std::vector<bool> rises = find_rising();
  double before = 0., after = 0.;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const auto n_elements = static_cast<double>(bodies_[b].n_elements);
    before += n_elements;
    after += n_elements * (rises[b] ? std::pow(growths_[b], n) : 1.);
  }
  return after / before;
}

double BodyLevels::error_behind() const {
  const std::vector<bool> rises = find_rising();
  double error = 0.;
  for (std::size_t b = 0; b < rises.size(); ++b)
    if (!rises[b])
      error += errors_[b];
  return error;
}

unsigned int BodyLevels::rises_to_target() const {
  const double behind = error_behind();
  return static_cast<unsigned int>(
      std::ceil(std::log2((error_.error - behind) / (target_ - behind)) / error_.order));
}

void BodyLevels::rise() {
  const std::vector<bool> rises = find_rising();
  double risen = 0., rising = 0.;
  for (std::size_t b = 0; b < rises.size(); ++b) {
    risen += has_risen_[b] ? errors_[b] : 0.;
    rising += rises[b] ? errors_[b] : 0.;
    levels_[b] += rises[b] ? 1 : 0;
  }
  // The next difference is that of the bodies that rise alone.
  if (risen > 0.)
    difference_ *= rising / risen;
  has_risen_ = rises;
  ++level_;
}

void BodyLevels::restart() { *this = BodyLevels(levels_.size(), level_ + 1, target_); }

} // namespace billet
