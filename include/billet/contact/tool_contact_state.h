// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_CONTACT_STATE_H
#define BILLET_CONTACT_TOOL_CONTACT_STATE_H

#include "billet/contact/friction_account.h"
#include "billet/contact/traction.h"

#include <deal.II/base/tensor.h>

namespace billet {

/// State that follows from the position of a node that may touch a tool.
struct ToolContactState {
  dealii::Tensor<1, 3> position;
  dealii::Tensor<1, 3> normal;
  dealii::Tensor<2, 3> turning; ///< ∂n/∂x
  double gap = 0.;              ///< to the surface raised by the gap offset
  unsigned int patch = 0;
  ContactStatus status = ContactStatus::open;
  double pressure = 0.;
  dealii::Tensor<1, 3> traction;
  dealii::Tensor<2, 3> tangent; ///< −∂traction/∂x
  double slip_increment = 0.;
  FrictionAccount friction;      ///< of this step
  double tangential_energy = 0.; ///< per area
  double share = 1.;             ///< s, of the normal penalty
  double fading_stiffness = 0.;  ///< in addition to that of the penalties [stress/length]
  bool is_behind = false;        ///< has missed the tool's surface, ...
  bool is_passed = false;        ///< ... and is in front of the surface now
};

/// Whether the nearest point is on a concave edge, or on a fillet smaller than the penetration. The
/// normal then turns with the node, by (T2) with g tr H = 1, and two faces press. `gap` and
/// `turning` are those of the surface.
inline bool is_in_concave_edge(const double gap, const dealii::Tensor<2, 3> &turning) {
  constexpr double turns = 0.5;
  return gap < 0. && gap * dealii::trace(turning) > turns;
}

} // namespace billet

#endif
