// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/snapshots.h"

#include "billet/spent_time.h"

namespace billet {

namespace {
constexpr double rounding = 1e-8; // relative tolerance of times
}

unsigned int Snapshots::count_intervals(const double time) const {
  return static_cast<unsigned int>(time / output_.interval * (1. + rounding));
}

bool Snapshots::is_due(const unsigned int step, const double time) const {
  if (output_.interval > 0. && time >= (n_intervals_ + 1) * output_.interval * (1. - rounding))
    return true;
  return (output_.interval == 0. && output_.every_steps > 0 && step % output_.every_steps == 0) ||
         time >= end_;
}

void Snapshots::after_step(const unsigned int step, const Solution &solution) {
  const double time = solution.state().time;
  if (!is_due(step, time))
    return;
  if (output_.interval > 0.)
    n_intervals_ = count_intervals(time);
  write(solution);
}

void Snapshots::write(const Solution &solution) {
  if (solution.state().time == last_)
    return;
  const TimedWork timed(Work::fields);
  writer_.write(solution);
  last_ = solution.state().time;
}

void Snapshots::save(StateWriter &writer) const {
  writer.write("snapshots", {static_cast<double>(n_intervals_), last_});
}

void Snapshots::load(const StateReader &reader) {
  const std::vector<double> state = reader.read("snapshots", 2);
  last_ = state.at(1);
  if (output_.interval > 0.)
    n_intervals_ = count_intervals(last_);
}

} // namespace billet
