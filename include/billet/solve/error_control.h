// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_ERROR_CONTROL_H
#define BILLET_SOLVE_ERROR_CONTROL_H

#include "billet/solve/penetration_errors.h"
#include "billet/solve/step_errors.h"

namespace billet {

/// Keeps the error of force curves within bounds, ∫Σ|F − F*| dt over ∫Σ|F*| dt, F the forces of
/// tools and pairs of bodies. Differences that are measured now and then yield an error estimate
/// for all steps so far, and the maximum length of the next step. It is independent of the problem
/// that is solved; doc/theory.md derives it.
///
/// A step of length h with return mapping to a yield surface or friction cone leaves an error c h².
/// Errors of steps add up. From the same state, one step of 2 h and two steps of h differ by 4 c h²
/// − 2 c h², the error of the two steps. If only tractions depend on the path, half of the error
/// fades every two steps, and 4 c h² remains.
class ErrorControl {
public:
  using Forces = ResultGroup;

  struct Tolerances {
    double steps = 0.;       ///< part of the forces; 0: steps are left alone
    double penetration = 0.; ///< part of the forces; 0: penetrations are left alone
    bool fade = false;       ///< see StepErrors::Rules
    bool stays = false;
  };
  ErrorControl(const Tolerances &tolerances, const double end_time)
      : course_(end_time), steps_({tolerances.steps, tolerances.fade, tolerances.stays}),
        penetrations_(tolerances.penetration) {}

  /// Begins at this time.
  void begin(const double time) { course_.begin(time); }

  double start() const { return course_.start(); }

  /// See ForceCourse. For the steps and measurements from here on.
  void set_min_size(const double size) { course_.set_min_size(size); }
  /// Adds an accepted step of length `h`. `residual`: at its end, as part of the forces;
  /// `penetration`: the deepest, see measure_penetration().
  void accept(double h, const Forces &forces, double residual, double penetration);

  /// Whether the next two steps should be compared with one of twice the length. Before the first
  /// force and after the last one this is false.
  bool wants_measurement() const { return steps_.wants_measurement(course_); }
  /// Whether to compare before a step of this length: the last steps were much shorter, or it is
  /// the last opportunity for a first comparison.
  bool wants_measurement(const double h) const { return steps_.wants_measurement(course_, h); }
  /// Compares forces after the second of two steps of length `h` with those of one step of twice
  /// the length. The difference that `residuals` (part of the forces) can explain does not count.
  void measure_steps(const double h, const Forces &forces, const Forces &of_one_step,
                     const double residuals) {
    steps_.measure(course_, h, forces, of_one_step, residuals);
  }
  /// Notes that two steps of this length cannot be compared with one: another measurement is due
  /// soon. If the comparison `failed`, it is due with shorter steps.
  void miss_measurement(const double h, const bool failed) { steps_.miss(h, failed); }
  /// Whether so many comparisons in a row have failed that only Newton's method controls steps
  /// until one succeeds.
  bool has_given_up() const { return steps_.has_given_up(); }

  /// See PenetrationErrors.
  bool wants_penetration() const { return penetrations_.wants_measurement(); }
  double allowed_at_first() const { return penetrations_.allowed_at_first(); }
  /// Compares forces of a step with those without penetration. `penetration`: the deepest in the
  /// step, over the smallest penetration tolerance that may be set. The difference that `residuals`
  /// can explain does not count.
  void measure_penetration(const double penetration, const Forces &forces, const Forces &without,
                           const double residuals) {
    penetrations_.measure(course_, penetration, forces, without, residuals);
  }
  /// Notes that the error by penetration was not found. If contact `touches`, another measurement
  /// is due after some steps, else as soon as one is possible.
  void miss_penetration(const bool touches) { penetrations_.miss(touches); }

  /// Returns the maximum length of the next step.
  double longest_step() const { return steps_.longest_step(); }
  /// Returns the maximum penetration allowed, in units of that of measure_penetration().
  double penetration_allowed() const { return penetrations_.allowed(course_.work()); }

  struct Estimate {
    double steps = 0., penetration = 0., iterations = 0.; ///< parts of the forces
    double total() const { return steps + penetration + iterations; }
  };
  /// Returns the error estimate for all steps so far.
  Estimate estimate() const;
  /// Whether there have been forces to normalise errors by.
  bool has_forces() const { return course_.work() > 0.; }
  unsigned int n_measurements() const { return steps_.n_measurements(); }
  /// Whether the error by penetration has been measured, or there was no penetration.
  bool knows_penetration() const { return penetrations_.is_known(); }

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  ForceCourse course_;
  StepErrors steps_;
  PenetrationErrors penetrations_;
  double iterations_ = 0.; ///< time integral of the errors by residuals
};

} // namespace billet

#endif
