// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TRACTION_H
#define BILLET_CONTACT_TRACTION_H

#include "billet/friction/friction_law.h"
#include "billet/parameters/control.h"

#include <array>
#include <cmath>

namespace billet {

/// Step of central differences for ContactTangent::numerical, over the size of a facet.
constexpr double difference_step = 1e-7;

using parameters::ContactTangent;

enum class ContactStatus { open = 0, stick = 1, slip = 2 };

/// Maximum penalty, relative to E/h, to which augmentation raises penalties: each augmentation then
/// leaves little penetration.
constexpr double enough_penalty = 10.;
/// Maximum factor by which the program may raise penalties beyond that.
constexpr double max_raise = 100.;

/// Returns the largest power of 2 not above a factor of penalties. Products of such powers are
/// exact in any order, so that a restarted run has bitwise identical penalties.
inline double whole_octaves(const double factor) { return std::exp2(std::floor(std::log2(factor))); }

/// Penalties of a node [force/length³].
struct ContactStiffness {
  double normal;
  double tangential;
};

/// Traction of a slave node in its contact frame, t = (t_q, t_r, p), and its derivative, both per
/// current area.
struct FrameTraction {
  ContactStatus status;
  double pressure;                      ///< p = k_n <−g> >= 0 [stress], eq. (9)
  std::array<double, 2> tangential;     ///< on q and r [stress]
  std::array<double, 2> slip;           ///< irreversible part of the increment, on q and r [length]
  std::array<double, 2> pressure_slope; ///< ∂(t_q, t_r)/∂p of a node that slips
  /// −∂(t_q, t_r, p)/∂(u_q, u_r, u_n) of the node's motion relative to the tool [stress/length]
  std::array<std::array<double, 3>, 3> tangent;
};

/// The relative tangential motion of a node over a step, on the current q and r.
struct TangentialIncrement {
  std::array<double, 2> value; ///< Δg [length]
  /// ∂Δg/∂(u_q, u_r, u_n): (1 0 0; 0 1 0) on a plane. The rotation of the frame and, where a node
  /// enters contact within the step, its entry contribute. Only exact tangents set it.
  std::array<std::array<double, 3>, 2> gradient{{{1., 0., 0.}, {0., 1., 0.}}};
  /// The slip rate is slip × this [1/time]. In a step without duration this is 0, and `rate` is the
  /// slip rate.
  double per_time = 0.;
  double rate = 0.;
};

/// Method by which the tangents of a kind are computed.
enum class TangentForm {
  numerical, ///< by central differences
  exact,     ///< derivatives of everything that the forces depend on
  closed     ///< in closed form, for facets that keep their place: FrictionTangent has its terms
};
TangentForm form_of(ContactTangent kind);

/// Terms of the derivative of friction that a kind of tangents keeps, see compute_traction(). They
/// are chosen once, outside loops over nodes.
struct FrictionTangent {
  double min_beta = 0.; ///< lower bound of β
  double upper = 1.;    ///< factor of the coupling t̂⊗n
  double lower = 0.;    ///< factor of its mirror image n⊗t̂

  static FrictionTangent of(ContactTangent kind);
};

/// Computes friction by return map, with elastic stick (Bittencourt & Creus 1998, eqs. (21)-(40));
/// the slave's normal points against n. With L(p, γ/Δt) the friction law's limit, μ p for Coulomb's
/// law:
/// - trial: t* = t_n − k_t Δg;
/// - stick, if |t*| ≤ L(p, 0): t = t*;
/// - slip otherwise: |t*| − k_t γ = L(p, γ/Δt), t = L t*/|t*|.
///
/// If `gap` >= 0, the node touches without traction, and sticks once it is pressed.
///
/// `tangential_n` is the traction at the start of the step. Tangents per area, with β = L/|t*|,
/// t̂ = t*/|t*|, ρ = L_v/(k_t Δt + L_v), and L_p and L_v the limit's slopes:
/// - stick: k_n n⊗n + k_t P, eq. (58);
/// - consistent: k_n n⊗n + β k_t (P − t̂⊗t̂) + L_p (1 − ρ) k_n t̂⊗n + ρ k_t t̂⊗t̂, eqs. (55)-(57);
/// - continuum: the same with β = 1, eq. (50);
/// - symmetrised upper: the triangle of the consistent one that holds the coupling t̂⊗n, mirrored;
/// - symmetrised lower: the triangle that does not, mirrored;
/// - symmetrised mean: half of each;
/// - exact: as for stick and consistent, with the increment's gradient in place of P.
FrameTraction compute_traction(const FrictionLaw &law, const ContactStiffness &stiffness,
                               const FrictionTangent &tangent, double gap,
                               const std::array<double, 2> &tangential_n,
                               const TangentialIncrement &increment);

/// Computes the traction without friction: only pressure and k_n n⊗n.
FrameTraction compute_frictionless_traction(double normal_stiffness, double gap);

} // namespace billet

#endif
