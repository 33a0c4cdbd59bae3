// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/gap_offsets.h"

#include "billet/scene/scene.h"

#include <algorithm>
#include <cmath>

namespace billet {

void MultiplierOffsets::start_augmentation(const std::size_t n) {
  is_used_ = true;
  offsets_.resize(n);
  last_.resize(n);
  Usage::count(Capability::augmentation, n);
  memory_.set(offsets_.size() * (sizeof(double) + sizeof(Augmentation)));
}

void MultiplierOffsets::augment_one(const std::size_t s, const std::optional<double> &gap_less_offset) {
  const double gap = gap_less_offset ? *gap_less_offset + offsets_[s] : 0.;
  const double next = gap_less_offset ? std::max(0., offsets_[s] - find_pace(s, gap) * gap) : 0.;
  last_[s] = {offsets_[s], gap};
  offsets_[s] = next;
}

double MultiplierOffsets::find_pace(const std::size_t s, const double gap) const {
  const auto [offset_before, gap_before] = last_[s];
  const double taken_up = offsets_[s] - offset_before, closed = gap - gap_before;
  // The secant does not apply if the motion of neighbours dominates the change.
  const bool continues =
      gap_before * gap > 0. && std::abs(gap) < std::abs(gap_before) && taken_up * closed > 0.;
  constexpr double fastest = 4.;
  return continues ? std::clamp(taken_up / closed, 1., fastest) : 1.;
}

void MultiplierOffsets::restart() {
  offsets_ = offsets_n_;
  last_.clear();
}

void MultiplierOffsets::scale(const double normal) {
  for (auto &offset : offsets_)
    offset /= normal;
  for (auto &offset : offsets_n_)
    offset /= normal;
  last_.assign(last_.size(), Augmentation());
}

void MultiplierOffsets::set(std::optional<std::vector<double>> offsets) {
  is_used_ = offsets.has_value();
  offsets_n_ = std::move(offsets).value_or(std::vector<double>());
  offsets_ = offsets_n_;
}

void InitialPenetrations::assign(const std::size_t n, const double penetration) {
  is_used_ = true;
  penetrations_.assign(n, penetration);
}

void InitialPenetrations::start(const std::size_t n) {
  is_used_ = true;
  penetrations_.resize(n);
}

void InitialPenetrations::set(std::optional<std::vector<double>> penetrations) {
  is_used_ = penetrations.has_value();
  penetrations_ = std::move(penetrations).value_or(std::vector<double>());
}

double InitialPenetrations::counted(const double penetration, const double part) {
  return InitialOverlap::counted(penetration, part);
}

} // namespace billet
