// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_ERROR_CONTROL_H
#define BILLET_SOLVE_ERROR_CONTROL_H

#include "billet/state.h"

#include <deal.II/base/tensor.h>

#include <limits>
#include <vector>

namespace billet {

/// Keeps the error of force curves within bounds, ∫Σ|F − F*| dt over ∫Σ|F*| dt, F the forces of tools and
/// pairs of bodies: from differences that are measured now and then follow an estimate of what all steps so
/// far have made, and the longest next step. Knows nothing of what is solved; doc/theory.md derives it.
///
/// Steps that return stresses to a yield surface or tractions to a friction cone have a force at their end
/// that belongs to their mean direction of flow: it is off by c h, h the step, c changing slowly. The force
/// after one step of 2 h less that after two of h is 2 c h − c h: the error itself.
class ErrorControl {
public:
  using Forces = std::vector<dealii::Tensor<1, 3>>;

  struct Tolerances {
    double steps = 0.;       ///< part of the forces; 0: steps are left alone
    double penetration = 0.; ///< part of the forces; 0: penetrations are left alone
  };
  explicit ErrorControl(const Tolerances &tolerances) : tolerances_(tolerances) {}

  /// What the next two steps should be compared with one of twice the length.
  bool wants_measurement() const { return until_measurement_ == 0; }

  /// An accepted step of length `h`. `residual`: of the forces, at its end, as part of them.
  void accept(double h, const Forces &forces, double residual);
  /// After the second of two steps of length `h`: what one of twice the length gave.
  void measure_steps(double h, const Forces &forces, const Forces &of_one_step);
  /// What a step gave whose deepest penetration was `penetration`, as part of the tightest that may be asked
  /// for; and what without penetrations.
  void measure_penetration(double penetration, const Forces &forces, const Forces &without);
  /// The measurement could not be made; another one is due soon.
  void miss_measurement();

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
  unsigned int n_measurements() const { return n_measurements_; }

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  double force_scale() const;
  /// How much more, or less, than on average the next steps may be off.
  static double leeway(double spent, double tolerance);

  Tolerances tolerances_;
  double time_ = 0., last_force_ = 0.;
  double work_ = 0.;                                       ///< ∫Σ|F| dt
  double steps_ = 0., penetration_ = 0., iterations_ = 0.; ///< integrals of errors
  double slope_ = 0.;                                      ///< c, of the last measurement
  double penetration_error_ = 0.;                          ///< of the last measurement
  double unmeasured_ = 0., unmeasured_time_ = 0.;          ///< Σ h², Σ h of the steps before the first one
  bool has_slope_ = false, has_penetration_ = false;
  unsigned int until_measurement_ = 0, interval_ = 2, n_measurements_ = 0;
  double longest_step_ = std::numeric_limits<double>::infinity();
  double penetration_allowed_ = std::numeric_limits<double>::infinity();
};

} // namespace billet

#endif
