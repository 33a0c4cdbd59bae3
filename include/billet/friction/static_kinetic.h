// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FRICTION_STATIC_KINETIC_H
#define BILLET_FRICTION_STATIC_KINETIC_H

#include "billet/friction/friction_limit.h"

#include <cmath>

namespace billet {

/// A coefficient that falls from its static to its kinetic value as sliding gets faster (Oden & Martins
/// 1985):
///   μ = μ_k + (μ_s − μ_k) exp(−c v),   v the slip rate.
struct StaticKinetic {
  double static_coefficient;  ///< μ_s >= μ_k
  double kinetic_coefficient; ///< μ_k > 0
  double decay;               ///< c >= 0 [time/length]

  FrictionLimit limit(const double pressure, const double slip_rate) const {
    const double excess = (static_coefficient - kinetic_coefficient) * std::exp(-decay * slip_rate);
    const double coefficient = kinetic_coefficient + excess;
    return {coefficient * pressure, coefficient, -decay * excess * pressure};
  }
};

} // namespace billet

#endif
