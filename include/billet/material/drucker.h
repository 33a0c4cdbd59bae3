// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_DRUCKER_H
#define BILLET_MATERIAL_DRUCKER_H

#include "billet/material/isochoric_energy.h"

#include <array>
#include <string>

namespace billet {

/// Returns the least eigenvalue of ∂²W/∂e∂e on Σ de = 0, over 2 G, (V6) of doc/theory/rubber.md. If
/// it is negative, an increment of strain exists against which the stress does no work, which
/// Drucker's condition excludes.
double min_drucker_stiffness(const IsochoricEnergy &energy, const IsochoricStrains &e);

/// Stretches of a deformation mode of an incompressible solid within which Drucker's condition
/// holds.
struct StableRange {
  const char *mode;       ///< "uniaxial", "equibiaxial" or "planar"
  double lowest, highest; ///< stretches; those at the ends of the search are not limits
};
/// Ends of the search for limits.
inline constexpr double min_searched_stretch = 0.1, greatest_searched_stretch = 10.;

/// Returns the ranges of three modes around the undeformed state, to a relative error of 1e-3.
std::array<StableRange, 3> find_stable_ranges(const IsochoricEnergy &energy);

/// Returns words such as "stable from 0.1 to 2.3 (uniaxial), ..."; empty if it is stable from 0.1
/// to 10 in all modes.
std::string describe_stability(const IsochoricEnergy &energy);

} // namespace billet

#endif
