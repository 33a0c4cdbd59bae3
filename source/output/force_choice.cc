// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/force_choice.h"

#include <algorithm>

namespace billet {

namespace {

struct Factors {
  /// Force times lever over moment, below which a load is a couple. What forces of round-off are.
  static constexpr double couple = 1e-3;
  /// By how much a load has to exceed one that is shown to take its place, so that few headers are
  /// printed.
  static constexpr double larger = 1.5;
  /// Load over the largest one, below which it takes no place: round-off.
  static constexpr double negligible = 1e-6;
};

} // namespace

ForceChoice::ForceChoice(const std::size_t n_loads, const std::size_t max_shown, const double lever)
    : lever_(lever), max_shown_(std::min(n_loads, max_shown)), max_(n_loads) {
  for (std::size_t i = 0; i < max_shown_; ++i)
    shown_.push_back({i, false});
}

bool ForceChoice::is_moment(const std::size_t load) const {
  return max_[load].force * lever_ < Factors::couple * max_[load].moment;
}

double ForceChoice::size(const std::size_t load) const {
  return is_moment(load) ? max_[load].moment / lever_ : max_[load].force;
}

bool ForceChoice::update(const std::vector<Load> &loads) {
  double largest = 0.;
  for (std::size_t i = 0; i < max_.size(); ++i) {
    max_[i] = {std::max(max_[i].force, loads[i].force), std::max(max_[i].moment, loads[i].moment)};
    largest = std::max(largest, size(i));
  }
  if (!(largest > 0.))
    return false;
  const auto is_shown = [this](const std::size_t load) {
    return std::any_of(shown_.begin(), shown_.end(),
                       [load](const Shown &shown) { return shown.load == load; });
  };
  // A load that is shown stays before one that is a little larger.
  const auto rank = [&](const std::size_t load) {
    return is_shown(load) ? Factors::larger * size(load) : size(load);
  };
  std::vector<std::size_t> order;
  for (std::size_t load = 0; load < max_.size(); ++load)
    if (size(load) > Factors::negligible * largest)
      order.push_back(load);
  std::stable_sort(order.begin(), order.end(),
                   [&](const std::size_t a, const std::size_t b) { return rank(a) > rank(b); });
  order.resize(std::min(order.size(), max_shown_));
  std::sort(order.begin(), order.end());
  std::vector<Shown> chosen;
  for (const std::size_t load : order)
    chosen.push_back({load, is_moment(load)});
  if (chosen == shown_)
    return false;
  shown_ = std::move(chosen);
  return true;
}

} // namespace billet
