// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FRICTION_SHEAR_LIMITED_H
#define BILLET_FRICTION_SHEAR_LIMITED_H

#include "billet/friction/friction_limit.h"

namespace billet {

/// Coulomb's law up to the shear stress that the material below the surface can bear (Orowan 1943):
/// min(μ p, τ_max).
struct ShearLimited {
  double coefficient;    ///< μ > 0
  double largest_stress; ///< τ_max > 0 [stress]

  FrictionLimit limit(const double pressure, double) const {
    if (coefficient * pressure < largest_stress)
      return {coefficient * pressure, coefficient, 0.};
    return {largest_stress, 0., 0.};
  }
};

} // namespace billet

#endif
