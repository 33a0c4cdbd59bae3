// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/softness_limit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace billet {

namespace {

/// Constants of (L7), as parts of forces unless they say otherwise.
struct SoftnessLimits {
  /// Missing part of a force up to which nothing is augmented.
  static constexpr double allowed = 2e-3;
  /// Minimum force of a pair, as part of the largest one, and minimum friction, as part of the
  /// pressure.
  static constexpr double min_of_max = 0.01, min_friction = 0.02;
  /// Minimum of the friction that is still allowed, as part of the allowed one. Slip persists: the
  /// allowance that one step uses is lost for the next ones.
  static constexpr double min_left = 0.1;
  /// Part of the force above which springs hold so much that the state is unlike the one in which
  /// `counts` was measured.
  static constexpr double unlike = 0.5;
  /// Maximum of ρ, the ratio of the geometric series of all further augmentations.
  static constexpr double max_ratio = 0.8;
  /// Minimum part that springs hold for ρ to be measured. Smaller parts of a force are not
  /// significant.
  static constexpr double min_held = 1e-4;
  /// The same for sheets, where less is not significant beside the residual.
  static constexpr double min_held_of_sheet = 0.01;
  /// ρ of sheets where it is not measured.
  static constexpr double unknown_ratio = 0.5;
};

double max_force(const std::vector<ContactSprings> &springs) {
  double maximum = 0.;
  for (const auto &of_pair : springs)
    maximum = std::max(maximum, of_pair.normal.force);
  return maximum;
}

} // namespace

double SoftnessLimit::Direction::missing(const ContactSprings::Direction &springs, const double force) const {
  const double in_all = counts / (1. - std::min(counts, SoftnessLimits::max_ratio));
  return std::min(changed,
                  springs.held > SoftnessLimits::unlike * force ? springs.held : in_all * springs.held);
}

void SoftnessLimit::Direction::learn(const ContactSprings::Direction &before, const Change &change,
                                     const Rule rule) {
  // Only the first augmentation counts: facets that do not fit keep gaps.
  const bool is_first = std::isinf(changed);
  changed = change.in_all;
  if (is_first && before.held > SoftnessLimits::min_held * before.force && before.held > 0.)
    counts = std::min(1., change.of_nodes / before.held);
  if (rule == Rule::sheet) {
    const double ratio = before.held > SoftnessLimits::min_held_of_sheet * before.force
                             ? std::min(change.in_all / before.held, SoftnessLimits::max_ratio)
                             : SoftnessLimits::unknown_ratio;
    changed *= ratio / (1. - ratio);
  }
}

SoftnessLimit::SoftnessLimit(const std::vector<Rule> &rules) : pairs_(rules.size()) {
  set_rules(rules);
  begin();
}

void SoftnessLimit::set_rules(const std::vector<Rule> &rules) {
  for (std::size_t i = 0; i < rules.size(); ++i)
    pairs_[i].rule = rules[i];
}

void SoftnessLimit::begin() {
  for (Pair &pair : pairs_)
    pair.normal.changed = pair.tangential.changed = std::numeric_limits<double>::infinity();
}

bool SoftnessLimit::is_used() const {
  return std::any_of(pairs_.begin(), pairs_.end(), [](const Pair &pair) { return pair.rule != Rule::none; });
}

std::vector<double> SoftnessLimit::excess(const std::vector<ContactSprings> &springs,
                                          const double resolved) const {
  const double minimum = SoftnessLimits::min_of_max * max_force(springs);
  std::vector<double> result(pairs_.size());
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair &pair = pairs_[i];
    if (pair.rule == Rule::none)
      continue;
    const auto &[normal, tangential] = springs[i];
    const double pressure = std::max(minimum, normal.force),
                 friction = std::max(SoftnessLimits::min_friction * pressure, tangential.force);
    const double of_pressure = pair.normal.missing(normal, pressure),
                 of_friction = pair.tangential.missing(tangential, friction),
                 left = std::max(SoftnessLimits::min_left * SoftnessLimits::allowed * friction,
                                 SoftnessLimits::allowed * friction - pair.let_in);
    if (of_pressure > 0.)
      result[i] += of_pressure / (SoftnessLimits::allowed * pressure);
    if (pair.rule == Rule::general && of_friction > resolved * pressure)
      result[i] += of_friction / left;
  }
  return result;
}

void SoftnessLimit::learn(const std::vector<ContactSprings> &before,
                          const std::vector<std::array<Change, 2>> &changes) {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    pairs_[i].normal.learn(before[i].normal, changes[i][0], pairs_[i].rule);
    pairs_[i].tangential.learn(before[i].tangential, changes[i][1], pairs_[i].rule);
  }
}

void SoftnessLimit::commit(const std::vector<ContactSprings> &springs, const double resolved) {
  if (springs.empty())
    return;
  const std::vector<double> excess_left = excess(springs, resolved);
  for (std::size_t i = 0; i < springs.size(); ++i) {
    Pair &pair = pairs_[i];
    pair.let_in += pair.tangential.counts * springs[i].tangential.held;
    pair.max_force = std::max(pair.max_force, springs[i].normal.force);
    if (excess_left[i] > 1.) // without a change if the first augmentation has failed
      pair.unsettled = std::max(pair.unsettled, std::isfinite(pair.normal.changed)
                                                    ? pair.normal.changed
                                                    : pair.normal.missing(springs[i].normal, pair.max_force));
  }
}

std::vector<double> SoftnessLimit::unsettled() const {
  std::vector<double> result;
  for (const Pair &pair : pairs_)
    result.push_back(pair.unsettled > 0. ? pair.unsettled / pair.max_force : 0.);
  return result;
}

std::vector<double> SoftnessLimit::save() const {
  std::vector<double> numbers;
  for (const Pair &pair : pairs_)
    numbers.insert(numbers.end(),
                   {pair.normal.counts, pair.tangential.counts, pair.let_in, pair.max_force, pair.unsettled});
  return numbers;
}

void SoftnessLimit::load(const std::vector<double> &numbers) {
  constexpr std::size_t of_pair = 5;
  if (numbers.size() != of_pair * pairs_.size())
    return; // saved for other pairs
  const double *next = numbers.data();
  for (Pair &pair : pairs_) {
    pair.normal.counts = next[0];
    pair.tangential.counts = next[1];
    pair.let_in = next[2];
    pair.max_force = next[3];
    pair.unsettled = next[4];
    next += of_pair;
  }
}

} // namespace billet
