// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_PENETRATION_ERRORS_H
#define BILLET_SOLVE_PENETRATION_ERRORS_H

#include "billet/solve/force_course.h"
#include "billet/solve/measurement_interval.h"
#include "billet/solve/result_group.h"

#include <limits>
#include <vector>

namespace billet {

/// Errors that penetrations make of forces, in proportion to the deepest one, and the penetration to allow.
/// Penetrations are in units of the tightest that may be asked for.
class PenetrationErrors {
public:
  /// `tolerance`: part of the forces; 0: penetrations are left alone.
  explicit PenetrationErrors(const double tolerance) : tolerance_(tolerance) {}

  /// Adds an accepted step of length `h`, at whose end the forces are `force` and the deepest penetration is
  /// this.
  void accept(double h, double force, double penetration);
  /// Whether the next measurement should tell, too, what penetrations make: at first, and then the more
  /// seldom the less it is, or changes.
  bool wants_measurement() const { return interval_.is_due(); }
  /// Returns what penetrations may make of the forces, as part of them, in the step that is the first to
  /// measure it.
  double allowed_at_first() const {
    return is_measured_ || tolerance_ == 0. ? std::numeric_limits<double>::infinity()
                                            : most_over_mean * tolerance_;
  }
  /// Adds a measurement, see ErrorControl::measure_penetration(), after a step of this course.
  void measure(const ForceCourse &course, double penetration, const ResultGroup &forces,
               const ResultGroup &without, double residuals);
  /// Notes that nothing was found; see ErrorControl::miss_penetration().
  void miss(const bool touches) { interval_.wait(touches && is_measured_ ? MeasurementInterval::max : 0); }

  /// Returns the deepest penetration to allow.
  double allowed() const { return allowed_; }
  /// Returns the integral of the errors over time.
  double integral() const { return integral_; }
  /// Whether it has been measured what penetrations make, or there were none.
  bool is_known() const { return is_measured_ || !(unmeasured_ > 0.); }

  // For checkpoints: the numbers that are of this class among those of ErrorControl.
  void save(std::vector<double> &numbers) const;
  void load(const std::vector<double> &numbers);

private:
  /// Augmentations leave less than what is allowed, about half of it in the mean.
  static constexpr double most_over_mean = 2.;

  double tolerance_;
  double integral_ = 0.;
  double slope_ = 0.;      ///< part of the forces by the deepest penetration, as of the last measurement
  double unmeasured_ = 0.; ///< ∫ penetration Σ|F| dt of the steps since the last measurement
  bool is_measured_ = false;
  MeasurementInterval interval_{0};
  double allowed_ = std::numeric_limits<double>::infinity();
};

} // namespace billet

#endif
