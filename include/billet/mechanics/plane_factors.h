// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_PLANE_FACTORS_H
#define BILLET_MECHANICS_PLANE_FACTORS_H

#include "billet/material/moduli.h"

namespace billet {

/// Factors from the in-plane part of a deviator that varies along a direction of a brick to the
/// plane stress that varies, (B19) of doc/theory.
struct PlaneFactors {
  double mean, rest; ///< of its trace, and of what is left
};

/// Returns the factors of displacements: 3 (1 + ν)/(1 − ν) and 1.
inline PlaneFactors plane_factors_of_displacements(const ElasticModuli &elastic) {
  return {27. * elastic.bulk / (3. * elastic.bulk + 4. * elastic.shear), 1.};
}

} // namespace billet

#endif
