// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/snapshots.h"

#include "billet/spent_time.h"
#include "billet/times.h"

namespace billet {

bool Snapshots::is_due(const unsigned int step, const double time) const {
  if (output_.interval > 0. && times::count_intervals(time, output_.interval) > n_intervals_)
    return true;
  return (output_.interval == 0. && output_.every_steps > 0 && step % output_.every_steps == 0) ||
         time >= end_;
}

void Snapshots::after_step(const unsigned int step, const Solution &solution) {
  const double time = solution.state().time;
  if (!is_due(step, time))
    return;
  if (output_.interval > 0.)
    n_intervals_ = static_cast<unsigned int>(times::count_intervals(time, output_.interval));
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
    n_intervals_ = static_cast<unsigned int>(times::count_intervals(last_, output_.interval));
}

} // namespace billet
