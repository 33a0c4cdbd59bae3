// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FRICTION_COULOMB_H
#define BILLET_FRICTION_COULOMB_H

#include "billet/friction/friction_limit.h"

namespace billet {

/// Coulomb's law, μ p: Bittencourt & Creus (1998), eq. (21).
struct Coulomb {
  double coefficient; ///< μ > 0

  FrictionLimit limit(const double pressure, double) const {
    return {coefficient * pressure, coefficient, 0.};
  }
};

} // namespace billet

#endif
