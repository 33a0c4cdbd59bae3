// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_EXPLICIT_CLOCK_H
#define BILLET_SOLVE_EXPLICIT_EXPLICIT_CLOCK_H

#include "billet/errors.h"
#include "billet/state.h"

#include <string>

namespace billet {

/// Time of explicit dynamics, and the steps that lead to the next event. Equal or slowly changing
/// steps conserve energy best. Steps grow by 2 % at a time, and faster while they are much shorter
/// than allowed.
class ExplicitClock {
public:
  /// Failures name the scene's file.
  explicit ExplicitClock(std::string file_name) : file_name_(std::move(file_name)) {}

  double time() const { return time_; }
  /// Returns the step from time() on; before plan(), the one that leads to time() [time].
  double step() const { return step_; }
  /// Returns the step before that, after plan().
  double step_before() const { return step_before_; }
  unsigned int n_steps() const { return n_steps_; }
  /// Whether no step has been taken since the start, or since a restart that is not exact.
  bool is_at_start() const { return n_steps_ == 0; }
  /// Returns the time since the last forces, 0 for the first ones; before plan().
  double since_forces() const { return is_at_start() ? 0. : step_; }

  /// Chooses the step from time() on, at most `allowed`: a whole number of equal steps leads to
  /// `event`, as long as they may stay equal. Throws SolutionFailure if time would not advance.
  void plan(double event, double allowed);
  /// Moves to the end of the step.
  void advance();

  /// Makes steps that were planned earlier lead to this event.
  void plan_to(double event);
  /// Starts at time t instead of 0.
  void begin(const double t) { time_ = t; }
  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

  /// Returns a failure at this time.
  SolutionFailure failure(const Explanation &why) const;

private:
  std::string file_name_;
  double time_ = 0., step_ = 0., step_before_ = 0.;
  /// Whether steps were much shorter than allowed, and are still short.
  bool is_growing_ = false;
  double event_ = 0.; ///< end of the planned steps
  /// Steps taken; steps of the present length before the event.
  unsigned int n_steps_ = 0, n_planned_ = 0;
  double time_before_ = 0.; ///< time of the last forces, after advance()
};

} // namespace billet

#endif
