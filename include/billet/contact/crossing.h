// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CROSSING_H
#define BILLET_CONTACT_CROSSING_H

#include <deal.II/base/tensor.h>

#include <algorithm>

namespace billet {

/// Position of a node relative to a surface.
struct SurfaceSide {
  enum class Side {
    front,
    behind,
    beyond ///< beyond the edge of the surface, neither in front of nor behind it
  };
  Side side;
  double distance;             ///< to the surface, >= 0 [length]
  dealii::Tensor<1, 3> normal; ///< unit, at the nearest point of the surface
  /// Whether the node is so deep behind the surface that the nearest point is about to change to
  /// the other side of the wall.
  bool is_too_deep;
};

/// Computes the part of a motion, from 0 to 1, that a node may perform before it has gone through a
/// surface. It has gone through if it came in from the front and is too deep, or nearer to another
/// side of the wall.
///
/// The method is conservative advancement (Mirtich, Impulse-based Dynamic Simulation, 1996, ch. 2).
/// A node in front at distance d meets nothing along the next length d of its path. `locate(s)`
/// returns its side after part s of the motion; `length` bounds its path relative to any point of
/// the surface. Near the surface and behind it, increments are at least `finest` and 1e-4 of the
/// motion. This bounds the cost of corrections by a nearly singular matrix, which may have any
/// size.
///
/// The returned part is below the limit by at most 1/32 of this minimum.
///
/// The signed distance is continuous where a node goes through the surface, and jumps where it
/// comes in from beyond the edge. Only the first case counts. A node that is too deep at the start
/// has no limit here.
///
/// Inside a wall, a node changes from behind one face to behind the opposite face. If it comes to
/// the front of the opposite face instead, the surface is folded, and the node is between the
/// flanks of the fold.
template <class Locate>
double find_free_part(const Locate &locate, const double length, const double finest) {
  constexpr double max_places = 1e4;
  const double resolution = std::max(finest, length / max_places);
  using Side = SurfaceSide::Side;
  enum class State { outside, inside, hidden };
  SurfaceSide here = locate(0.);
  if (here.is_too_deep)
    return 1.;
  State state = here.side == Side::behind ? State::inside : State::outside;
  dealii::Tensor<1, 3> entry = here.normal;
  // The limit identifies the other side of a wall or of a sharp wedge. Two faces that meet at the
  // edge of a block do not qualify: a node may be nearer to either.
  constexpr double opposite = -0.5;
  const auto is_through = [&](const SurfaceSide &there) {
    return (there.side == Side::behind && there.is_too_deep) ||
           (there.side != Side::beyond && there.normal * entry < opposite);
  };
  constexpr double slack = 0.1; // of the path: jumps are larger
  for (double s = 0.; s < 1.;) {
    if (state == State::outside && here.distance >= (1. - s) * length)
      return 1.;
    const double way = std::max(resolution, state == State::inside ? 0.5 * here.distance : here.distance);
    const double next = std::min(1., s + way / length), moved = (next - s) * length;
    const SurfaceSide there = locate(next);
    if (state == State::outside && there.side == Side::behind) {
      state = here.distance + there.distance > (1. + slack) * moved ? State::hidden : State::inside;
      entry = here.side == Side::front && here.distance > 0. ? here.normal : there.normal;
    }
    if (state == State::inside && is_through(there)) {
      double free = s, through = next;
      constexpr double fine = 1. / 32.; // of the resolution
      while ((through - free) * length > fine * resolution) {
        const double middle = 0.5 * (free + through);
        (is_through(locate(middle)) ? through : free) = middle;
      }
      here = locate(through);
      if (here.side == Side::behind)
        return free;
      s = through; // the other flank of a fold
      state = State::outside;
      continue;
    }
    if (there.side != Side::behind)
      state = State::outside;
    s = next;
    here = there;
  }
  return 1.;
}

} // namespace billet

#endif
