// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_STEP_ERRORS_H
#define BILLET_SOLVE_STEP_ERRORS_H

#include "billet/solve/force_course.h"
#include "billet/solve/measurement_interval.h"
#include "billet/solve/result_group.h"
#include "billet/state.h"

#include <limits>
#include <vector>

namespace billet {

/// Errors of forces by the length of steps, and the maximum length of the next step. ErrorControl
/// describes how errors depend on the length.
class StepErrors {
public:
  struct Rules {
    double tolerance = 0.; ///< part of the forces; 0: steps are not controlled
    bool fade = false;     ///< errors of steps fade, else they add up
    /// Sudden growth of errors persists, as in the rate of a tool under a force whose body yields.
    /// Otherwise it may be a single event, such as a node that begins to slip, and does not count
    /// for all steps.
    bool stays = false;
  };
  explicit StepErrors(const Rules &rules) : rules_(rules) {}

  /// Adds an accepted step of length `h`. `n_forces`: the number of forces at its end.
  void accept(double h, std::size_t n_forces);
  /// Whether a measurement is due. Before a step of length `h` it may be due earlier; see
  /// ErrorControl::wants_measurement().
  bool wants_measurement(const ForceCourse &course) const {
    return interval_.is_due() && course.force() > 0.;
  }
  bool wants_measurement(const ForceCourse &course, double h) const;
  /// Adds a measurement; see ErrorControl::measure_steps().
  void measure(const ForceCourse &course, double h, const ResultGroup &forces, const ResultGroup &of_one_step,
               double residuals);
  /// Notes a missing measurement; see ErrorControl::miss_measurement().
  void miss(double h, bool failed);
  bool has_given_up() const { return n_failed_ > max_failed; }

  /// Returns the maximum length of the next step.
  double longest_step() const { return longest_step_; }
  /// Returns the integral of the errors over time.
  double integral() const { return integral_; }
  unsigned int n_measurements() const { return n_measurements_; }

  // For checkpoints.
  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  static constexpr unsigned int max_failed = 5; ///< comparisons in a row

  /// Slope c of the errors that follows from the difference between one step and two.
  struct Slope {
    double value, last;
    double maximum;  ///< upper bound, with all noise
    bool is_first;   ///< of these forces
    bool is_known;   ///< difference exceeds the noise
    ResultGroup now; ///< c of each force
  };
  Slope slope_of(double h, const ResultGroup &forces, const ResultGroup &of_one_step, double difference,
                 double noise) const;
  /// Restarts the count of steps since the last measurement, and uses these slopes from here on.
  void take(const Slope &slope, double h);
  void schedule(const ForceCourse &course, const Slope &slope, double h);
  void add_step(double h);
  /// Returns the maximum growth rate of the error of forces from now on.
  double allowed_rate(const ForceCourse &course) const;
  /// Returns the error of the forces at the end by steps of length `h`, if each pair of them adds
  /// `slope` times 2 h².
  double left_at_the_end(const ForceCourse &course, double slope, double h) const;
  double rough_target() const { return rules_.fade ? rules_.tolerance : 2. * rules_.tolerance; }
  /// Chooses the maximum length after a measurement with steps of length `h`. `matter`: errors are
  /// relevant for the target; `is_known`: they exceed the noise.
  void choose_longest_step(const ForceCourse &course, double h, bool matter, bool is_known);
  /// Returns the factor by which steps may be longer than `h`.
  double allowed_stretch(const ForceCourse &course, double h) const;

  Rules rules_;
  ResultGroup slopes_;     ///< c of each force since the last measurement; empty before the first
  double last_slope_ = 0.; ///< Σ|c| at the last measurement
  ResultGroup errors_;     ///< of each force, by all steps so far
  double last_error_ = 0., integral_ = 0.;
  /// Σ h², Σ h of the steps since the last measurement.
  double unmeasured_ = 0., unmeasured_span_ = 0.;
  double measured_step_ = 0.; ///< h of the last one
  /// Difference of the last one, over h and the forces.
  double part_ = 0.;
  bool is_little_ = false; ///< whether errors by steps are small, at the last measurement
  MeasurementInterval interval_{1};
  unsigned int n_measurements_ = 0;
  unsigned int n_failed_ = 0; ///< comparisons in a row
  double longest_step_ = std::numeric_limits<double>::infinity();
  double longest_taken_ = 0.; ///< of all steps so far
};

} // namespace billet

#endif
