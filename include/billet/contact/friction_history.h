// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FRICTION_HISTORY_H
#define BILLET_CONTACT_FRICTION_HISTORY_H

#include "billet/geometry/frame.h"
#include "billet/state.h"

#include <array>

namespace billet {

/// Friction history of a node, in a contact frame that the node carries along.
struct FrictionHistory {
  bool is_active = false; ///< whether the other members are set
  Frame frame;
  std::array<double, 2> tangential{}; ///< traction on the frame's q and r [stress]
  double slip = 0.;                   ///< length of the path slipped [length]
  double slip_rate = 0.;              ///< [length/time]

  static constexpr std::size_t width = 17; ///< numbers of save()
  void save(RowWriter &row) const {
    row.number(is_active ? 1. : 0.);
    row.vector(frame.q).vector(frame.r).vector(frame.n).vector(frame.spin);
    row.number(tangential[0]).number(tangential[1]).number(slip).number(slip_rate);
  }
  void load(RowReader &row) {
    is_active = row.flag();
    for (auto *direction : {&frame.q, &frame.r, &frame.n, &frame.spin})
      row.vector(*direction);
    for (double *number : {&tangential[0], &tangential[1], &slip, &slip_rate})
      *number = row.number();
  }
};

} // namespace billet

#endif
