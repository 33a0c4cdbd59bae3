// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_VOLUMETRIC_ENERGY_H
#define BILLET_MATERIAL_VOLUMETRIC_ENERGY_H

#include <algorithm>
#include <cmath>

namespace billet {

/// Volumetric part U(J) of a stored energy, (V5) of doc/theory/rubber.md:
///   logarithmic  ½ κ ln²J
///   quadratic    ½ κ (J − 1)²
///   ogden        κ/β² (β ln J + J^{−β} − 1) (Ogden 1972b)
struct VolumetricEnergy {
  enum class Kind { logarithmic, quadratic, ogden };

  Kind kind = Kind::logarithmic;
  double bulk = 0.;     ///< κ [stress]
  double exponent = 9.; ///< β ≠ 0 of Ogden's

  /// Returns U per reference volume [stress].
  double energy(const double J) const {
    const double log_J = std::log(J);
    switch (kind) {
    case Kind::quadratic:
      return 0.5 * bulk * (J - 1.) * (J - 1.);
    case Kind::ogden:
      return bulk / (exponent * exponent) * (exponent * log_J + std::expm1(-exponent * log_J));
    case Kind::logarithmic:
      break;
    }
    return 0.5 * bulk * log_J * log_J;
  }
  /// Returns the mean Kirchhoff stress p = J U' [stress].
  double mean_stress(const double J) const {
    switch (kind) {
    case Kind::quadratic:
      return bulk * J * (J - 1.);
    case Kind::ogden:
      return -bulk / exponent * std::expm1(-exponent * std::log(J));
    case Kind::logarithmic:
      break;
    }
    return bulk * std::log(J);
  }
  /// Returns dp/d ln J [stress].
  double slope(const double J) const {
    switch (kind) {
    case Kind::quadratic:
      return bulk * J * (2. * J - 1.);
    case Kind::ogden:
      return bulk * std::pow(J, -exponent);
    case Kind::logarithmic:
      break;
    }
    return bulk;
  }
  /// Returns an upper bound of slope() at a mean stress.
  double bound_slope(const double mean_stress) const {
    switch (kind) {
    case Kind::quadratic:
      return bulk + 3. * std::max(mean_stress, 0.);
    case Kind::ogden:
      return bulk + std::abs(exponent * mean_stress);
    case Kind::logarithmic:
      break;
    }
    return bulk;
  }
};

} // namespace billet

#endif
