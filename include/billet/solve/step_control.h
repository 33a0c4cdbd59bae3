// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_STEP_CONTROL_H
#define BILLET_SOLVE_STEP_CONTROL_H

#include "billet/parameters/control.h"
#include "billet/state.h"

#include <vector>

namespace billet {

/// Chooses the step: fixed, or by the iterations that the last one needed. Knows nothing of what is solved.
///
/// Fixed steps have the length that was asked for, save the last one before a stop or an output time that is
/// no multiple of it away.
class StepControl {
public:
  /// Steps also end at the `stops`, and at multiples of `interval`, unless it is 0.
  StepControl(const parameters::TimeStepping &parameters, double interval, std::vector<double> stops = {});

  double time() const { return time_; }
  bool is_finished() const { return time_ >= parameters_.end_time; }

  /// Length of the step to try next from time(); ends exactly at the end time, at stops and at output times.
  double next_step() const;
  /// End of that step; exact where it is the end time or an output time.
  double next_time() const;

  /// `error`: that of the step's time integration, as part of what is allowed; it falls with the third power
  /// of the step. 0: does not count.
  void accept(unsigned int n_iterations, double error = 0.);

  /// Whether that step ends at a stop.
  bool ends_at_stop() const;
  /// End of the step after that, if it is as long, and as far as stops and output times let it.
  double time_after_next() const;
  /// Automatic steps: the next is no longer than this, nor shorter than the smallest one.
  void limit(double length);
  /// Automatic steps: the next has this length.
  void plan(double length);

  /// Cuts the step. False if that is not allowed: steps are fixed, or it would fall below the smallest one.
  bool reject();

  unsigned int n_steps() const { return n_steps_; }
  unsigned int n_cuts() const { return n_cuts_; }

  void save(StateWriter &writer) const;
  /// Goes on as if nothing had happened, or, where the scene now wants other steps, from that time with its
  /// initial step.
  void load(const StateReader &reader);
  /// Begins after so many steps at a time that another method has reached.
  void begin(double time, unsigned int n_steps);

private:
  double next_stop() const; ///< infinite after the last
  double target() const;
  double end_on_grid() const;
  /// What the lengths of steps depend on.
  std::vector<double> rules() const;

  parameters::TimeStepping parameters_;
  double interval_;
  std::vector<double> stops_; ///< ascending
  double time_ = 0.;
  double step_;
  /// The n-th fixed step ends at n times the step from here, so that a thousand of them add no round-off.
  double grid_start_ = 0.;
  unsigned int n_on_grid_ = 0;
  unsigned int n_steps_ = 0, n_cuts_ = 0;
};

} // namespace billet

#endif
