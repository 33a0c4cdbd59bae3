// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SPRING_ENERGY_H
#define BILLET_CONTACT_SPRING_ENERGY_H

#include <algorithm>
#include <cmath>

namespace billet {

/// Energy per area in the penalty springs of a node [energy/length²], and the areas on which it
/// acts. The excess over a limit acts on the area of the last step in which the node was below that
/// limit. Forces at any penetration then have the potential on_areas(), (T7) of doc/theory.md.
struct SpringEnergy {
  /// Marks a missing area from before the node was deep.
  static constexpr double no_area = -1.;

  double total;
  double on_current_area; ///< its part on the current area; the rest acts on the earlier area
  double share;           ///< ∂(on_current_area)/∂(total)

  /// Returns an energy that acts entirely on the current area.
  static SpringEnergy on_one_area(const double energy) { return {energy, energy, 1.}; }
  static SpringEnergy split(const double energy, const double limit) {
    if (energy <= limit)
      return on_one_area(energy);
    const double share = std::sqrt(limit / energy);
    return {energy, share * (2. - share) * energy, share};
  }

  bool is_split() const { return share < 1.; }
  /// Returns the area on which the node's traction acts, ∂(on_areas)/∂(total) [length²].
  double counted_area(const double area, const double area_before) const {
    return share == 1. || area_before == no_area ? area : share * area + (1. - share) * area_before;
  }
  /// Returns the energy of the springs on these areas [energy].
  double on_areas(const double area, const double area_before) const {
    const double before = area_before == no_area ? area : area_before;
    return area * on_current_area + before * (total - on_current_area);
  }
  /// Returns the maximum area that counts [length²].
  double max_area(const double area, const double area_before) const {
    return is_split() ? std::max(area, area_before) : area;
  }
};

} // namespace billet

#endif
