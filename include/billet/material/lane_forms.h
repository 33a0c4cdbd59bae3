// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_LANE_FORMS_H
#define BILLET_MATERIAL_LANE_FORMS_H

namespace billet {

/// Hardening laws that the explicit kernels compute for several elements at once. They evaluate
/// `other` through a callback, one lane at a time, but a rate factor of it at once. σ_y(α) is
/// concave except for `other`.
enum class HardeningKind { linear, voce, power_law, other };

/// Rate factors that the explicit kernels compute for several elements at once: 1, and 1 +
/// (ε̇/D)^{1/p}. Kernels evaluate a flow stress with an `other` through a callback, one lane at a
/// time.
enum class RateKind { none, power_law, other };

/// Maximum count of numbers that a flow stress stores at a point beside α.
constexpr unsigned int max_flow_state = 4;

/// Laws that the explicit kernels compute for several elements at once. The last one determines the
/// count.
enum class LaneLaw { hencky, neo_hookean, hypoelastic };
constexpr unsigned int n_lane_laws = static_cast<unsigned int>(LaneLaw::hypoelastic) + 1;

/// Parameters of a rate factor, in the user's units.
struct LaneRate {
  RateKind kind = RateKind::other;
  double reference = 0., exponent = 0.; ///< D and p of the power law
};

/// Parameters of a flow stress, in the user's units.
struct LaneHardening {
  HardeningKind kind = HardeningKind::other;
  double yield_stress = 0., hardening_modulus = 0.;    ///< linear; Voce
  double saturation_stress = 0., saturation_rate = 0.; ///< Voce
  double prestrain = 0., exponent = 0., strength = 0.; ///< power law
  LaneRate rate = {RateKind::none};
};

} // namespace billet

#endif
