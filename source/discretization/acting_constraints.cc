// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/acting_constraints.h"

namespace billet {

ActingConstraints::ActingConstraints(const Scene &scene, const ConstraintFilter &acts) : scene_(scene) {
  visit([&](const Constraint &constraint) {
    may_change_ = may_change_ || !constraint.times.always();
    if (!acts(constraint))
      resting_.insert(&constraint);
  });
}

bool ActingConstraints::differ(const ConstraintFilter &acts) const {
  bool differs = false;
  if (may_change_)
    visit(
        [&](const Constraint &constraint) { differs = differs || acts(constraint) != (*this)(constraint); });
  return differs;
}

std::vector<double> ActingConstraints::fade_times(const ConstraintFilter &acts) const {
  std::set<double> times;
  visit([&](const Constraint &constraint) {
    if ((*this)(constraint) && !acts(constraint))
      times.insert(constraint.times.fade_time);
  });
  return {times.begin(), times.end()};
}

void ActingConstraints::release(const ConstraintFilter &acts, const double fade_time) {
  visit([&](const Constraint &constraint) {
    if ((*this)(constraint) && !acts(constraint) && constraint.times.fade_time == fade_time)
      resting_.insert(&constraint);
  });
  ++n_changes_;
}

std::set<double> ActingConstraints::take(const ConstraintFilter &acts) {
  std::set<double> times;
  bool changes = false;
  visit([&](const Constraint &constraint) {
    if ((*this)(constraint) || !acts(constraint))
      return;
    resting_.erase(&constraint);
    changes = true;
    if (constraint.times.is_late())
      times.insert(constraint.times.from);
  });
  if (changes)
    ++n_changes_;
  return times;
}

void ActingConstraints::change_to(const ConstraintFilter &acts) {
  for (const double fade_time : fade_times(acts))
    release(acts, fade_time);
  take(acts);
}

std::set<double> ActingConstraints::late_beginnings() const {
  return billet::late_beginnings(scene_,
                                 [this](const Constraint &constraint) { return (*this)(constraint); });
}

std::set<double> late_beginnings(const Scene &scene, const ConstraintFilter &acts) {
  std::set<double> times;
  for (const Body &body : scene.bodies())
    for (const Constraint &constraint : body.constraints)
      if (constraint.times.is_late() && acts(constraint))
        times.insert(constraint.times.from);
  return times;
}

} // namespace billet
