// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_ERROR_CONTROL_H
#define BILLET_SOLVE_ERROR_CONTROL_H

#include "billet/solve/penetration_errors.h"
#include "billet/solve/step_errors.h"

namespace billet {

/// Keeps the error of force curves within bounds, ∫Σ|F − F*| dt over ∫Σ|F*| dt, F the forces of tools and
/// pairs of bodies: from differences that are measured now and then follow an estimate of what all steps so
/// far have made, and the longest next step. Knows nothing of what is solved; doc/theory.md derives it.
///
/// A step of length h that returns stresses to a yield surface, or tractions to a friction cone, in the
/// direction of its whole motion leaves an error c h², and errors of steps add up. From the same state one
/// step of 2 h differs from two of h by 4 c h² − 2 c h²: by what the two are off. Tractions alone, without
/// stresses that depend on their way, forget it: every two steps half of what was, so that 4 c h² is left.
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

  /// Adds an accepted step of length `h`. `residual`: of the forces, at its end, as part of them;
  /// `penetration`: the deepest, see measure_penetration().
  void accept(double h, const Forces &forces, double residual, double penetration);

  /// Whether the next two steps should be compared with one of twice the length. Where nothing acts yet, or
  /// no more, that would tell nothing.
  bool wants_measurement() const { return steps_.wants_measurement(course_); }
  /// Whether they should before a step of this length: where the last ones were much shorter, or where it is
  /// the last occasion for the first comparison.
  bool wants_measurement(const double h) const { return steps_.wants_measurement(course_, h); }
  /// Compares forces after the second of two steps of length `h` with those of one step of twice the length.
  /// What `residuals` make of the difference, as part of the forces, does not count.
  void measure_steps(const double h, const Forces &forces, const Forces &of_one_step,
                     const double residuals) {
    steps_.measure(course_, h, forces, of_one_step, residuals);
  }
  /// Notes that two steps of this length cannot be compared with one: another measurement is due soon. If
  /// that one `failed`, of shorter ones.
  void miss_measurement(const double h, const bool failed) { steps_.miss(h, failed); }
  /// Whether so many comparisons in a row have failed that steps are left to Newton's method until one
  /// succeeds.
  bool has_given_up() const { return steps_.has_given_up(); }

  /// See PenetrationErrors.
  bool wants_penetration() const { return penetrations_.wants_measurement(); }
  double allowed_at_first() const { return penetrations_.allowed_at_first(); }
  /// Compares forces of a step whose deepest penetration was `penetration`, as part of the tightest that may
  /// be asked for, with those without penetrations. What `residuals` make of the difference does not count.
  void measure_penetration(const double penetration, const Forces &forces, const Forces &without,
                           const double residuals) {
    penetrations_.measure(course_, penetration, forces, without, residuals);
  }
  /// Notes that the error by penetrations was not found, where some bear, or nothing `touches`: another
  /// measurement is due after some steps, or as soon as there is one to take.
  void miss_penetration(const bool touches) { penetrations_.miss(touches); }

  /// The next step should not be longer.
  double longest_step() const { return steps_.longest_step(); }
  /// The deepest penetration to allow, in units of that of measure_penetration().
  double penetration_allowed() const { return penetrations_.allowed(); }

  struct Estimate {
    double steps = 0., penetration = 0., iterations = 0.; ///< parts of the forces
    double total() const { return steps + penetration + iterations; }
  };
  /// Of all steps so far.
  Estimate estimate() const;
  /// Whether there have been forces that errors can be parts of.
  bool has_forces() const { return course_.work() > 0.; }
  unsigned int n_measurements() const { return steps_.n_measurements(); }
  /// Whether it has been measured what penetrations make, or there were none.
  bool knows_penetration() const { return penetrations_.is_known(); }

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  ForceCourse course_;
  StepErrors steps_;
  PenetrationErrors penetrations_;
  double iterations_ = 0.; ///< integral of the errors that residuals make
};

} // namespace billet

#endif
