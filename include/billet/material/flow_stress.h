// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_FLOW_STRESS_H
#define BILLET_MATERIAL_FLOW_STRESS_H

#include "billet/material/lane_forms.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace billet {

/// Plastic strain of a step and the flow stress at its end.
struct PlasticIncrement {
  double strain = 0.; ///< Δα ≥ 0
  double slope = 0.;  ///< derivative of the flow stress by Δα there [stress]
};

/// Solves q − m Δα − σ_y(α_n + Δα) = 0 for Δα > 0, given that the left side is positive at Δα = 0.
/// Newton's method is safeguarded by a shrinking bracket, so it converges for hardening laws with
/// kinks or steep starts. It stops at round-off. `law` has stress(α) and slope(α).
template <class Law>
double solve_consistency(const Law &law, const double q, const double m, const double alpha_n) {
  double low = 0., high = q / m;
  double delta = 0.;
  const double tolerance = 4. * std::numeric_limits<double>::epsilon() * q;
  for (unsigned int i = 0; i < 200; ++i) {
    const double f = q - m * delta - law.stress(alpha_n + delta);
    if (std::abs(f) <= tolerance)
      break;
    (f > 0. ? low : high) = delta;
    double next = delta + f / (m + law.slope(alpha_n + delta));
    if (!(next > low && next < high))
      next = 0.5 * (low + high);
    if (next == delta)
      break;
    delta = next;
  }
  return delta;
}

/// Flow stress of J2 plasticity, in the sense of von Mises [stress]. A point stores the equivalent
/// plastic strain α. If the flow stress depends on more than α, it also stores n_state() more
/// numbers, initially zero.
class FlowStress {
public:
  static constexpr std::size_t max_state = max_flow_state;
  using State = std::array<double, max_state>;

  virtual ~FlowStress() = default;

  /// Returns a description for messages and checkpoints, such as "linear hardening".
  virtual std::string description() const = 0;

  /// Returns the stress at which a point begins to yield.
  virtual double stress(double alpha) const = 0;

  /// Returns the Δα with q − m Δα = flow stress at the end of a step of dt [time]. Where q does not
  /// exceed stress(α_n), it is zero, with the slope at α_n.
  virtual PlasticIncrement solve(double q, double m, double alpha_n, double dt) const = 0;

  virtual std::size_t n_state() const { return 0; }
  /// Returns the numbers of a state that are in use.
  std::vector<double> numbers_of(const State &state) const {
    return {state.begin(), state.begin() + static_cast<std::ptrdiff_t>(n_state())};
  }
  /// Overwrites `state` with the state at the end of a step.
  virtual void advance(double alpha_n, double delta_alpha, double dt, const State &state_n,
                       State &state) const {
    (void)alpha_n, (void)delta_alpha, (void)dt, (void)state_n, (void)state;
  }
  /// Returns the plastic work per reference volume up to a state [stress].
  virtual double plastic_work(double alpha, const State &state) const = 0;

  /// Returns the plastic work of a point that has flowed at a vanishing rate [stress].
  virtual double plastic_work_at_rest(double alpha) const = 0;

  /// Whether the flow stress stays below a limit for any plastic strain.
  virtual bool is_bounded() const = 0;

  /// Returns the form in which kernels compute it for several elements at once; by default one lane
  /// at a time. With a rate factor that kernels have, the state is the plastic work alone.
  virtual LaneHardening lane_form() const { return {}; }

  /// Returns the derivative of stress(), from the right where it has a kink [stress].
  virtual double slope(double alpha) const = 0;
};

} // namespace billet

#endif
