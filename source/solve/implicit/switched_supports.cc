// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/switched_supports.h"

#include <algorithm>
#include <utility>

namespace billet {

Vector SwitchedSupports::switch_supports(const double t, const Vector &reactions,
                                         const Vector &displacements) {
  fading_.erase(std::remove_if(fading_.begin(), fading_.end(),
                               [t](const Fading &fading) { return fading.times.end() <= t; }),
                fading_.end());
  // What the constraints leave of the reactions changes by what the supports that end have borne.
  Vector left_before = reactions, remaining = reactions;
  supports_.condense(left_before);
  remaining = 0.;
  for (const double fade_time : supports_.acting().fade_times(holding_after(t))) {
    supports_.release(t, fade_time);
    Vector left = reactions;
    supports_.condense(left);
    Vector released = left;
    released -= left_before;
    left_before = left;
    if (fade_time > 0.) {
      remaining += released;
      fading_.push_back({{t, fade_time}, released});
    }
  }
  supports_.take(t, displacements);
  return remaining;
}

bool SwitchedSupports::changes(const double t_n, const double t) const {
  return std::any_of(fading_.begin(), fading_.end(),
                     [&](const Fading &fading) { return fading.times.left(t) != fading.times.left(t_n); });
}

void SwitchedSupports::add_forces(const double t, Vector &residual) const {
  for (const Fading &fading : fading_)
    residual.add(-fading.times.left(t), fading.forces);
}

double SwitchedSupports::work(const double t_n, const double t, const Vector &increment) const {
  double work = 0.;
  for (const Fading &fading : fading_)
    work += 0.5 * (fading.times.left(t) + fading.times.left(t_n)) * (fading.forces * increment);
  return work;
}

void SwitchedSupports::save(StateWriter &writer, const OwnedNodes &nodes) const {
  std::set<double> starts;
  for (const auto &start : supports_.starts())
    starts.insert(start.first);
  save_support_starts(writer, starts, [&](const std::string &name, const double time) {
    save_nodal(writer, name, nodes, supports_.starts().at(time));
  });
  std::vector<FadeTimes> times;
  for (const Fading &fading : fading_)
    times.push_back(fading.times);
  save_support_fades(writer, times, [&](const std::string &name, const std::size_t i) {
    save_nodal(writer, name, nodes, fading_[i].forces);
  });
}

void SwitchedSupports::load(const StateReader &reader, const OwnedNodes &nodes, const double t,
                            const Vector &displacements) {
  std::map<double, Vector> starts;
  const auto load = [&](const std::string &name, const double time) {
    Vector start = discretization_.make_owned_vector();
    load_nodal(reader, name, nodes, start);
    starts[time] = discretization_.make_ghosted_vector();
    starts[time] = start;
  };
  for (const double time : load_support_starts(reader, late_beginnings(scene_, holding_after(t)), load))
    starts.insert_or_assign(time, Vector(displacements)); // a copy keeps the ghosts
  if (supports_.acting().may_change())
    supports_.resume(t, std::move(starts));
  fading_.clear();
  load_support_fades(reader, [&](const std::string &name, const FadeTimes &times) {
    fading_.push_back({times, discretization_.make_owned_vector()});
    load_nodal(reader, name, nodes, fading_.back().forces);
  });
}

} // namespace billet
