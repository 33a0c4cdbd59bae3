// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/explicit_clock.h"

#include "billet/diagnostic_kinds.h"
#include "billet/times.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

namespace {

/// Limits of steps, as factors unless they say otherwise.
struct ExplicitClockLimits {
  /// Growth of steps of the allowed length, as part of them, and maximum factor of shorter steps.
  /// The error of a step change by a part p scales with p (ω Δt)²: short steps may grow faster.
  static constexpr double growth = 0.02, max_growth = 2.;
  /// Parts of the allowed step: below the first, steps begin to grow, and they grow up to the
  /// second.
  static constexpr double short_step = 0.9, long_step = 0.99;
  /// Maximum number of steps that are planned at once, for the counter's range.
  static constexpr double max_planned = 1e9;
  /// Number of steps to the event from which on they are below the resolution of time.
  static constexpr double too_many = 1e15;
};

} // namespace

void ExplicitClock::plan(const double event, const double allowed) {
  step_before_ = step_;
  const double length = step_ / allowed;
  const double longest =
      n_steps_ > 0 ? std::min(allowed, std::min(ExplicitClockLimits::max_growth,
                                                1. + ExplicitClockLimits::growth / (length * length)) *
                                           step_)
                   : allowed;
  const double remaining = event - time_;
  const double n = times::count_steps(remaining, longest);
  const double fresh = remaining / n;
  is_growing_ =
      step_ < (is_growing_ ? ExplicitClockLimits::long_step : ExplicitClockLimits::short_step) * allowed;
  const bool is_planned = n_planned_ > 0 && event_ == event && step_ <= allowed;
  // Near the event, new steps may be shorter than the planned ones: then the planned ones are kept.
  if (is_planned && !(is_growing_ && fresh > step_)) {
    --n_planned_;
    return;
  }
  step_ = fresh;
  const bool fits = n <= ExplicitClockLimits::max_planned; // else this step only is planned
  event_ = fits ? event : time_ + step_;
  n_planned_ = fits ? static_cast<unsigned int>(n) - 1 : 0;
  if (!(time_ + step_ > time_) || !(n < ExplicitClockLimits::too_many)) {
    std::ostringstream why;
    why << "the stable step, " << longest << ", is below the resolution of the time";
    throw failure({why.str(), "Check for nearly flat elements, low densities and high penalties; 'Mass "
                              "scaling step' increases it"});
  }
}

void ExplicitClock::advance() {
  time_before_ = time_;
  time_ = n_planned_ == 0 ? event_ : time_ + step_;
  ++n_steps_;
}

void ExplicitClock::plan_to(const double event) {
  if (event_ != event)
    n_planned_ = 0;
}

void ExplicitClock::save(StateWriter &writer) const {
  writer.write("time", {time_});
  writer.write("time before", {time_before_});
  writer.write("clock", {static_cast<double>(n_steps_), static_cast<double>(n_planned_), step_, step_before_,
                         is_growing_ ? 1. : 0., event_, time_before_});
}

void ExplicitClock::load(const StateReader &reader) {
  time_ = reader.number("time");
  const std::vector<double> clock = reader.read("clock", 7);
  n_steps_ = to_count(clock.at(0));
  n_planned_ = to_count(clock.at(1));
  step_ = clock.at(2);
  step_before_ = clock.at(3);
  is_growing_ = clock.at(4) != 0.;
  event_ = clock.at(5);
  time_before_ = clock.at(6);
}

SolutionFailure ExplicitClock::failure(const Explanation &why) const {
  return SolutionFailure(Diagnostic(diagnostic::solution_failed,
                                    file_name_ + ": after " + std::to_string(n_steps_) + " steps " + why.what)
                             .time(time_)
                             .advice(why.advice));
}

} // namespace billet
