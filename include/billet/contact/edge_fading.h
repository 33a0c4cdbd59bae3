// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_EDGE_FADING_H
#define BILLET_CONTACT_EDGE_FADING_H

#include "billet/contact/hardening_spring.h"
#include "billet/geometry/rigid_surface.h"

#include <deal.II/base/tensor.h>

namespace billet {

/// Width w of the zone beyond the edge of a tool's surface in which its pressure fades [facet
/// sizes].
constexpr double fading_width = 0.05;

/// Contact of a node beyond the edge of a tool's surface, where the pressure fades, (T3), (T4) of
/// doc/theory.md. The energy per area is s(d) e(−g), with s = (1 − d²/w²)² and e that of the
/// spring. The members are the terms in addition to a pressure p = −s ∂e/∂g along the normal.
struct EdgeFading {
  double share;                        ///< s, of the normal penalty
  dealii::Tensor<1, 3> push;           ///< [stress]
  dealii::Tensor<1, 3> pressure_slope; ///< ∂p/∂x at a fixed gap [stress/length]
  /// −∂(push + p n)/∂x, without ∂p/∂x at a fixed s [stress/length].
  dealii::Tensor<2, 3> tangent;
  double stiffness; ///< bound of the norm of `tangent` [stress/length]
};

/// Returns the fading at the position `edge_point`, for a `gap` to the surface. The pressure fades
/// in a zone of the `width` w [length]. Requires border.beyond < width.
EdgeFading compute_edge_fading(const RigidSurface::EdgePoint &edge_point, double width,
                               const HardeningSpring &penalty, double gap);

} // namespace billet

#endif
