// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_START_GAPS_H
#define BILLET_CONTACT_START_GAPS_H

#include <algorithm>
#include <limits>

namespace billet {

/// Sums over the nodes of a pair on this rank, to judge the gaps that it changes at the start,
/// (C15).
struct StartGaps {
  double force = 0., area = 0.; ///< of the nodes that press
  /// Slide of the partner, and facet size, each weighted by the force.
  double slide = 0., facets = 0.;
  /// Least and largest penetration that counts as none; a gap that counts as closed is negative.
  double least = std::numeric_limits<double>::infinity(), largest = -least;

  /// Adds a node with its force; `moved`: distance by which the partner has slid along the face
  /// there since the start [length].
  void add(const double of_force, const double of_area, const double moved, const double facet_size,
           const double penetration) {
    if (of_force > 0.) {
      force += of_force;
      area += of_area;
      slide += of_force * moved;
      facets += of_force * facet_size;
    }
    if (of_force > 0. || penetration != 0.) {
      least = std::min(least, penetration);
      largest = std::max(largest, penetration);
    }
  }
};

} // namespace billet

#endif
