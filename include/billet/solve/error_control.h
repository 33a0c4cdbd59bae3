// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_ERROR_CONTROL_H
#define BILLET_SOLVE_ERROR_CONTROL_H

#include "billet/state.h"

#include <deal.II/base/tensor.h>

#include <limits>
#include <string>
#include <vector>

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
  using Force = dealii::Tensor<1, 3>;
  using Forces = std::vector<Force>;
  /// Σ|F|, and Σ|F − F'|, of as many.
  static double size(const Forces &forces);
  static double distance(const Forces &a, const Forces &b);

  struct Tolerances {
    double steps = 0.;       ///< part of the forces; 0: steps are left alone
    double penetration = 0.; ///< part of the forces; 0: penetrations are left alone
    bool fade = false;       ///< errors of steps fade, else they add up
    /// What grows at once stays so, as the pace of a tool under a force does once its body yields; else it
    /// may have happened once, such as a node that begins to slip, and does not count for all steps.
    bool stays = false;
  };
  ErrorControl(const Tolerances &tolerances, const double end_time)
      : tolerances_(tolerances), end_time_(end_time) {}

  /// Begins at this time.
  void begin(const double time) { time_ = start_ = time; }

  double start() const { return start_; }

  /// Whether the next two steps should be compared with one of twice the length. Where nothing acts yet, or
  /// no more, that would tell nothing.
  bool wants_measurement() const { return until_measurement_ == 0 && last_force_ > 0.; }

  /// An accepted step of length `h`. `residual`: of the forces, at its end, as part of them; `penetration`:
  /// the deepest, see measure_penetration().
  void accept(double h, const Forces &forces, double residual, double penetration);
  /// Whether they should before a step of this length: where the last ones were much shorter, or where it is
  /// the last occasion for the first comparison.
  bool wants_measurement(const double h) const {
    constexpr double longer = 1.5, rounding = 1e-9;
    if (n_measurements_ == 0 && time_ + 3. * h > end_time_ * (1. + rounding))
      return true;
    return wants_measurement() || (n_measurements_ > 0 && last_force_ > 0. && h > longer * measured_step_);
  }
  /// After the second of two steps of length `h`: what one of twice the length gave. What `residuals` make of
  /// the difference, as part of the forces, does not count.
  void measure_steps(double h, const Forces &forces, const Forces &of_one_step, double residuals);
  /// Whether the next measurement should tell, too, what penetrations make: at first, and then the more
  /// seldom the less it is, or changes.
  bool wants_penetration() const { return until_penetration_ == 0; }
  /// What penetrations may make of the forces, as part of them, in the step that is the first to measure it.
  double allowed_at_first() const {
    return has_penetration_ || tolerances_.penetration == 0. ? std::numeric_limits<double>::infinity()
                                                             : most_over_mean * tolerances_.penetration;
  }
  /// What a step gave whose deepest penetration was `penetration`, as part of the tightest that may be asked
  /// for; and what without penetrations. What `residuals` make of the difference does not count.
  void measure_penetration(double penetration, const Forces &forces, const Forces &without, double residuals);
  /// What penetrations make was not found, where some bear, or nothing `touches`: another measurement after
  /// some steps, or as soon as there is one to take.
  void miss_penetration(bool touches) {
    until_penetration_ = touches && has_penetration_ ? longest_interval : 0;
  }
  /// Two steps of this length cannot be compared with one: another measurement is due soon. If that one
  /// `failed`, of shorter ones.
  void miss_measurement(double h, bool failed);
  /// So many comparisons in a row have failed that steps are left to Newton's method until one succeeds.
  bool has_given_up() const { return n_failed_ > most_failed; }

  /// The next step should not be longer.
  double longest_step() const { return longest_step_; }
  /// The deepest penetration to allow, in units of that of measure_penetration().
  double penetration_allowed() const { return penetration_allowed_; }

  struct Estimate {
    double steps = 0., penetration = 0., iterations = 0.; ///< parts of the forces
    double total() const { return steps + penetration + iterations; }
  };
  /// Of all steps so far.
  Estimate estimate() const;
  /// Whether there have been forces that errors can be parts of.
  bool has_forces() const { return work_ > 0.; }
  unsigned int n_measurements() const { return n_measurements_; }
  /// Whether it has been measured what penetrations make, or there were none.
  bool knows_penetration() const { return has_penetration_ || !(unmeasured_penetration_ > 0.); }

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);
  static void save(StateWriter &writer, const std::string &name, const Forces &forces);
  static Forces load(const StateReader &reader, const std::string &name);

private:
  /// Steps between measurements, where little changes from one to the next.
  static constexpr unsigned int longest_interval = 8;
  static constexpr unsigned int most_failed = 5; ///< in a row
  /// Augmentations leave less than what is allowed, about half of it in the mean.
  static constexpr double most_over_mean = 2.;

  double force_scale() const;
  void add_step_errors(double h);
  /// The error that steps may add to the forces in a unit of time from now on.
  double allowed_rate() const;
  /// What steps of length `h` leave of the forces at the end, if each pair of them makes `slope` times 2 h².
  double left_at_the_end(double slope, double h) const;
  /// After a measurement of steps of length `h`: whether their errors `matter` beside the target, and
  /// `is_known` beside the noise.
  void choose_longest_step(double h, bool matter, bool is_known);
  /// How much longer than `h` steps may be.
  double allowed_stretch(double h) const;

  Tolerances tolerances_;
  double end_time_;
  double start_ = 0., time_ = 0., last_force_ = 0., last_error_ = 0.;
  double work_ = 0.;                                       ///< ∫Σ|F| dt
  double steps_ = 0., penetration_ = 0., iterations_ = 0.; ///< integrals of errors
  double force_rate_ = 0.;                                 ///< d Σ|F| / dt in the last step
  Forces slopes_;          ///< c of each force from the last measurement on; empty before the first
  double last_slope_ = 0.; ///< Σ|c|, as the last measurement was
  Forces errors_;          ///< of each force, by all steps so far
  double penetration_slope_ =
      0.; ///< part of the forces by the deepest penetration, as of the last measurement
  double unmeasured_ = 0., unmeasured_span_ = 0.; ///< Σ h², Σ h of the steps since the last measurement
  double unmeasured_penetration_ = 0.; ///< ∫ penetration Σ|F| dt of the steps since its last one
  double measured_step_ = 0.;          ///< h of the last one
  double part_ = 0.;                   ///< difference of the last one, over h and the forces
  bool has_penetration_ = false;
  bool is_little_ = false; ///< what steps make, as of the last measurement
  unsigned int until_measurement_ = 1, interval_ = 1, n_measurements_ = 0;
  unsigned int n_failed_ = 0; ///< comparisons in a row
  unsigned int until_penetration_ = 0, penetration_interval_ = 1;
  double longest_step_ = std::numeric_limits<double>::infinity();
  double penetration_allowed_ = std::numeric_limits<double>::infinity();
};

} // namespace billet

#endif
