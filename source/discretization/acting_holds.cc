// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/acting_holds.h"

namespace billet {

ActingHolds::ActingHolds(const Scene &scene, const HoldFilter &acts) : scene_(scene) {
  visit([&](const Hold &hold) {
    may_change_ = may_change_ || !hold.times.always();
    if (!acts(hold))
      resting_.insert(&hold);
  });
}

bool ActingHolds::differ(const HoldFilter &acts) const {
  bool differs = false;
  if (may_change_)
    visit([&](const Hold &hold) { differs = differs || acts(hold) != (*this)(hold); });
  return differs;
}

std::vector<double> ActingHolds::fade_times(const HoldFilter &acts) const {
  std::set<double> times;
  visit([&](const Hold &hold) {
    if ((*this)(hold) && !acts(hold))
      times.insert(hold.times.fade_time);
  });
  return {times.begin(), times.end()};
}

void ActingHolds::release(const HoldFilter &acts, const double fade_time) {
  visit([&](const Hold &hold) {
    if ((*this)(hold) && !acts(hold) && hold.times.fade_time == fade_time)
      resting_.insert(&hold);
  });
  ++n_changes_;
}

std::set<double> ActingHolds::take(const HoldFilter &acts) {
  std::set<double> times;
  bool changes = false;
  visit([&](const Hold &hold) {
    if ((*this)(hold) || !acts(hold))
      return;
    resting_.erase(&hold);
    changes = true;
    if (hold.times.is_late())
      times.insert(hold.times.from);
  });
  if (changes)
    ++n_changes_;
  return times;
}

void ActingHolds::change_to(const HoldFilter &acts) {
  for (const double fade_time : fade_times(acts))
    release(acts, fade_time);
  take(acts);
}

std::set<double> ActingHolds::late_beginnings() const {
  return billet::late_beginnings(scene_, [this](const Hold &hold) { return (*this)(hold); });
}

std::set<double> late_beginnings(const Scene &scene, const HoldFilter &acts) {
  std::set<double> times;
  for (const Body &body : scene.bodies())
    for (const Hold &hold : body.holds)
      if (hold.times.is_late() && acts(hold))
        times.insert(hold.times.from);
  return times;
}

} // namespace billet
