// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_PENETRATION_ERRORS_H
#define BILLET_SOLVE_PENETRATION_ERRORS_H

#include "billet/solve/force_course.h"
#include "billet/solve/measurement_interval.h"
#include "billet/solve/result_group.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace billet {

/// Errors of forces by penetration, in proportion to the deepest one, and the penetration allowed.
/// Penetrations are in units of the smallest tolerance that may be set.
class PenetrationErrors {
public:
  /// `tolerance`: part of the forces; 0: penetration is not controlled.
  explicit PenetrationErrors(const double tolerance) : tolerance_(tolerance) {}

  /// Adds an accepted step of length `h`, with the sum of forces and the deepest penetration at its
  /// end.
  void accept(double h, double force, double penetration);
  /// Whether the next measurement should include penetration. The first one does; later ones are
  /// the rarer, the smaller and steadier the error is.
  bool wants_measurement() const { return interval_.is_due(); }
  /// Returns the maximum error by penetration, as part of the forces, in the first step that
  /// measures it. In a run of few steps it is much of the whole error.
  double allowed_at_first() const {
    return is_measured_ || tolerance_ == 0. ? std::numeric_limits<double>::infinity() : tolerance_;
  }
  /// Adds a measurement after the last step of `course`; see ErrorControl::measure_penetration().
  void measure(const ForceCourse &course, double penetration, const ResultGroup &forces,
               const ResultGroup &without, double residuals);
  /// Notes that no error was found; see ErrorControl::miss_penetration().
  void miss(const bool touches) { interval_.wait(touches && is_measured_ ? MeasurementInterval::max : 0); }

  /// Returns the maximum penetration allowed after forces of this integral over time. While the
  /// errors so far are within the tolerance, penetration may be larger than on average.
  double allowed(const double work) const {
    return std::max(1., integral_ > tolerance_ * work ? allowed_ : max_over_mean * allowed_);
  }
  /// Returns the integral of the errors over time.
  double integral() const { return integral_; }
  /// Whether the error by penetration has been measured, or there was no penetration.
  bool is_known() const { return is_measured_ || !(unmeasured_ > 0.); }

  // For checkpoints.
  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  /// Augmentation leaves less than allowed, about half of it on average. Penalties that need none
  /// may leave all of it.
  static constexpr double max_over_mean = 2.;

  double tolerance_;
  double integral_ = 0.;
  /// Error of the forces over the deepest penetration times what the stiffness of the bodies is in
  /// proportion to, at the last measurement.
  double slope_ = 0.;
  double unmeasured_ = 0.; ///< ∫ of the latter dt over the steps since the last measurement
  bool is_measured_ = false;
  MeasurementInterval interval_{0};
  double allowed_ = std::numeric_limits<double>::infinity(); ///< on average
};

} // namespace billet

#endif
