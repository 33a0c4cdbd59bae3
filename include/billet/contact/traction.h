// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TRACTION_H
#define BILLET_CONTACT_TRACTION_H

#include "billet/geometry/frame.h"
#include "billet/parameters/control.h"

#include <array>

namespace billet {

using parameters::ContactTangent;

enum class ContactStatus { open = 0, stick = 1, slip = 2 };

/// Penalties of a node [force/length³] and the friction coefficient of its pair.
struct ContactStiffness {
  double normal;
  double tangential;
  double friction_coefficient;
};

/// Traction of a slave node in its contact frame, t = (t_q, t_r, p), and its derivative, both per current
/// area.
struct FrameTraction {
  ContactStatus status;
  double pressure;                  ///< p = k_n <−g> >= 0 [stress], eq. (9)
  std::array<double, 2> tangential; ///< on q and r [stress]
  std::array<double, 2> slip;       ///< irreversible part of the increment, on q and r [length]
  /// −∂(t_q, t_r, p)/∂(u_q, u_r, u_n) of the node's motion relative to the tool [stress/length]
  std::array<std::array<double, 3>, 3> tangent;
};

/// Coulomb friction by return map, with elastic stick (Bittencourt & Creus 1998, eqs. (21)-(40)); the slave's
/// normal points against n.
///   trial   t* = t_n − k_t Δg
///   stick   |t*| ≤ μ p:  t = t*          slip   else:  t = μ p t*/|t*|
/// `gap` < 0; `tangential_n` the traction at the start of the step and `increment` Δg the relative tangential
/// displacement, both on the current q and r; `increment_slope` = ∂Δg/∂g, which is not zero where a node
/// enters contact within the step. Tangents, with β = μ p/|t*|, t̂ = t*/|t*| and areas held:
///   stick                  k_n n⊗n + k_t P                                              (58)
///   consistent             k_n n⊗n + β k_t (P − t̂⊗t̂) + μ k_n t̂⊗n                       (55)-(57)
///   continuum              the same with β = 1                                          (50)
///   symmetrised            upper: the triangle of (57) that holds the coupling μ k_n t̂⊗n, mirrored; lower:
///   the one
///                          that does not; mean: half of each
///   exact                  consistent, and the increment's slope over g
FrameTraction compute_traction(const ContactStiffness &stiffness, ContactTangent tangent, double gap,
                               const std::array<double, 2> &tangential_n,
                               const std::array<double, 2> &increment,
                               const std::array<double, 2> &increment_slope);

/// The same without friction: only pressure and k_n n⊗n.
FrameTraction compute_frictionless_traction(double normal_stiffness, double gap);

} // namespace billet

#endif
