// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FRICTION_PRESSURE_DEPENDENT_H
#define BILLET_FRICTION_PRESSURE_DEPENDENT_H

#include "billet/friction/friction_limit.h"

#include <cmath>

namespace billet {

/// A coefficient that falls with pressure, as lubricated sheets show (Filzek & Groche 2000):
///   μ = μ_0 (p/p_0)^(e − 1),   so that the limit μ p grows as p^e.
struct PressureDependent {
  double coefficient;        ///< μ_0 > 0, at the reference pressure
  double reference_pressure; ///< p_0 > 0 [stress]
  double exponent;           ///< 0 < e <= 1; 1 is Coulomb's law

  FrictionLimit limit(const double pressure, double) const {
    if (!(pressure > 0.)) // where the slope has no limit
      return {0., 0., 0.};
    const double mu = coefficient * std::pow(pressure / reference_pressure, exponent - 1.);
    return {mu * pressure, exponent * mu, 0.};
  }
};

} // namespace billet

#endif
