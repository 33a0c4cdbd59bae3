// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_STEP_CONTROL_H
#define BILLET_SOLVE_STEP_CONTROL_H

#include "billet/parameters/control.h"
#include "billet/state.h"

#include <vector>

namespace billet {

/// Chooses the step: fixed, or by the number of iterations of the last one. It is independent of
/// the problem that is solved.
///
/// Fixed steps have the given length. The last one before a stop or output time is shorter if that
/// time is not a multiple of it.
class StepControl {
public:
  /// Steps also end at the `stops`, and at multiples of `interval`, unless it is 0.
  StepControl(const parameters::TimeStepping &parameters, double interval, std::vector<double> stops = {});

  double time() const { return time_; }
  bool is_finished() const { return time_ >= parameters_.end_time; }

  /// Returns the length of the next step from time(). The step ends exactly at the end time, at
  /// stops and at output times.
  double next_step() const;
  /// Returns the end of that step; exact at the end time, at stops and at output times.
  double next_time() const;

  /// Accepts the step. `error`: of the step's time integration, as part of the allowed error; it
  /// falls with the third power of the step. 0: no control by the error.
  void accept(unsigned int n_iterations, double error = 0.);

  /// Whether the next step ends at a stop.
  bool ends_at_stop() const;
  /// Returns the end of the step after the next, of the same length or as far as stops and output
  /// times permit.
  double time_after_next() const;
  /// Automatic steps: limits the next step to this length, but not below the minimum step.
  void limit(double length);
  /// Automatic steps: sets the length of the next step.
  void plan(double length);

  /// Cuts the step. Returns false if that is not allowed: steps are fixed, or the step is already
  /// the minimum step.
  bool reject();

  unsigned int n_steps() const { return n_steps_; }
  unsigned int n_cuts() const { return n_cuts_; }

  void save(StateWriter &writer) const;
  /// Resumes as if the run had not been interrupted. If the scene now has other step settings, it
  /// continues from that time with its initial step.
  void load(const StateReader &reader);
  /// Begins after `n_steps` steps at a time that another method has reached.
  void begin(double time, unsigned int n_steps);

private:
  double next_stop() const; ///< infinite after the last
  double target() const;
  double end_on_grid() const;
  /// Returns the settings that determine step lengths.
  std::vector<double> rules() const;

  parameters::TimeStepping parameters_;
  double interval_;
  std::vector<double> stops_; ///< ascending
  double time_ = 0.;
  double step_;
  /// The n-th fixed step ends at n times the step from here, so that many steps accumulate no
  /// round-off.
  double grid_start_ = 0.;
  unsigned int n_on_grid_ = 0;
  unsigned int n_steps_ = 0, n_cuts_ = 0;
};

} // namespace billet

#endif
