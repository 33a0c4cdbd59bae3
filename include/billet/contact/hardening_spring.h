// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_HARDENING_SPRING_H
#define BILLET_CONTACT_HARDENING_SPRING_H

#include <limits>

namespace billet {

/// Penalty spring per area that becomes stiffer with its penetration d, (T11):
///
///   p = k d (1 + d²/d_0²),   e = ½ k d² (1 + ½ d²/d_0²),   dp/dd = k (1 + 3 d²/d_0²).
///
/// It has a potential and no history. An infinite d_0 makes it exactly linear.
struct HardeningSpring {
  double stiffness; ///< k [stress/length]
  /// d_0, at which its secant doubles [length].
  double penetration = std::numeric_limits<double>::infinity();

  double secant(const double d) const { return stiffness * (1. + square(d / penetration)); }
  double slope(const double d) const { return stiffness * (1. + 3. * square(d / penetration)); }
  double pressure(const double d) const { return secant(d) * d; }
  /// Returns the energy per area [energy/length²].
  double energy(const double d) const {
    return 0.5 * stiffness * d * d * (1. + 0.5 * square(d / penetration));
  }

private:
  static double square(const double x) { return x * x; }
};

} // namespace billet

#endif
