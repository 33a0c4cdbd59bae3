// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_STEP_WORKS_H
#define BILLET_CONTACT_STEP_WORKS_H

#include <algorithm>

namespace billet {

/// Works of a contact pair in a step in addition to forces times motions.
struct StepWorks {
  /// Work of pressure and friction on nodes that enter or leave within the step, which the
  /// trapezoidal rule miscounts, (A1) [energy].
  double touching = 0.;
  /// Work of the ramp of an initial penetration, (A2): it loads springs without a motion [energy].
  double ramp = 0.;

  StepWorks &operator+=(const StepWorks &other) {
    touching += other.touching;
    ramp += other.ramp;
    return *this;
  }

  /// Adds the works of a node. Its pressure forces are `force_n` and `force` at the ends of the
  /// step, its penetrations `penetration_n` and `penetration`, both 0 where it does not press.
  /// `closing` is its approach to the surface along the normal in the step, `ramp_penetration` the
  /// part of that due to the ramp. `weight` is that of the force at the end in the mean force.
  void add(const double force_n, const double force, const double penetration_n, const double penetration,
           const double closing, const double ramp_penetration, const double weight) {
    ramp += (weight * force + (1. - weight) * force_n) * ramp_penetration;
    // A gap is at most the motion of the node: a node that arrives from elsewhere has not closed
    // it.
    if (force_n == 0. && force > 0.)
      touching -= 0.5 * force * std::max(0., closing - penetration);
    else if (force_n > 0. && force == 0.)
      touching += 0.5 * force_n * std::max(0., -closing - penetration_n);
  }
};

} // namespace billet

#endif
