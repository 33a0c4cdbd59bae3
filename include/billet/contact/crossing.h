// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CROSSING_H
#define BILLET_CONTACT_CROSSING_H

#include <deal.II/base/tensor.h>

#include <algorithm>

namespace billet {

/// Where a node is, as seen from a surface.
struct SurfaceSide {
  enum class Side {
    front,
    behind,
    beyond ///< beside the border of the surface, neither before nor behind it
  };
  Side side;
  double distance;             ///< to the surface, >= 0 [length]
  dealii::Tensor<1, 3> normal; ///< unit, at the nearest point of the surface
  /// Behind by so much that the nearest point is about to change to the other side of what is below.
  bool is_too_deep;
};

/// Computes how much of a motion, from part 0 to part 1, a node may take until it has gone through a surface:
/// until it is too deep behind it, or nearer to another side of what is below, having come in from the front.
///
/// Conservative advancement (Mirtich, Impulse-based Dynamic Simulation, 1996, ch. 2): a node in front at
/// distance d cannot meet anything on its next d of way. `locate(s)` is where it is after part s of the
/// motion, `length` bounds its way relative to any point of the surface. Near the surface, and behind it, the
/// way goes on by `finest` at least, and by a ten thousandth of the motion: a matrix that is all but
/// singular corrects without measure. The part that is returned is short of the limit by 1/32 of that at
/// most.
///
/// The signed distance is continuous where a node goes through the surface, and jumps where it comes in from
/// beyond the border: only the first counts. A node that is too deep at the start has no limit here.
///
/// Inside a wall a node changes from behind one face to behind the opposite one. Where it comes to the front
/// of the opposite one instead, the surface is folded, and the node is between the flanks of the fold.
template <class Locate>
double find_free_part(const Locate &locate, const double length, const double finest) {
  constexpr double most_places = 1e4;
  const double resolution = std::max(finest, length / most_places);
  using Side = SurfaceSide::Side;
  enum class State { outside, inside, hidden };
  SurfaceSide here = locate(0.);
  if (here.is_too_deep)
    return 1.;
  State state = here.side == Side::behind ? State::inside : State::outside;
  dealii::Tensor<1, 3> entry = here.normal;
  // The other side of a wall or of a sharp wedge. The faces of a block at an edge are no such sides: a node
  // may be nearer to either.
  constexpr double opposite = -0.5;
  const auto is_through = [&](const SurfaceSide &there) {
    return (there.side == Side::behind && there.is_too_deep) ||
           (there.side != Side::beyond && there.normal * entry < opposite);
  };
  constexpr double slack = 0.1; // of the way: jumps are larger
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
