// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_KERNEL_H
#define BILLET_MECHANICS_EXPLICIT_KERNEL_H

#include <cstddef>
#include <cstdint>

// What ExplicitBlock and its kernels tell each other: plain numbers and pointers only. A kernel is compiled
// with instructions that not every processor has; an inline function of the standard library instantiated
// there could be the one that the linker keeps for the whole program.

namespace billet::explicit_kernels {

/// What a kernel asks of the ordinary code, one lane at a time, where there is no fast form.
struct LaneFunctions {
  /// Solves q − m Δα − σ_y(α + Δα) = 0 for the Δα > 0; `yield_stress` becomes σ_y(α + Δα).
  double (*harden)(const void *hardening, double q, double m, double alpha, double &yield_stress);
  /// dev ln b and tr ln b / 3 of a symmetric b (11, 22, 33, 12, 13, 23); false if b is not positive definite.
  bool (*logarithm)(const double *b, double *deviator, double &mean);
};

/// The laws that kernels know themselves, and `other`, for which LaneFunctions are asked. σ_y(α) must be
/// concave but for `other`.
enum class HardeningKind { linear, voce, power_law, other };

/// Constants of the body.
struct Material {
  double bulk, shear;
  HardeningKind hardening_kind;
  double yield_stress, hardening_modulus;    ///< linear; Voce
  double saturation_stress, saturation_rate; ///< Voce
  double prestrain, exponent, strength;      ///< power law
  const void *hardening;                     ///< the law, for LaneFunctions
  double density;
  double wave_speed;
  double linear_viscosity, quadratic_viscosity;
  double hourglass_stiffness;
};

/// One element takes these many numbers, in batches of as many elements as there are lanes: number k of batch
/// b and lane l stands at (b n + k) n_lanes + l.
struct Layout {
  std::size_t n_constants;
  std::size_t n_history;
  std::size_t n_point_history; ///< of which for each point
};

struct Elements {
  std::size_t n_elements;
  const std::uint32_t *nodes;        ///< 8 for each element, in batches like the others; padded with the last
  const double *reference_positions; ///< stride 4
  const double *constants;
  double *history;
  Layout layout;
};

struct Step {
  const double *displacements, *velocities;
  double *forces;
  double inverse_dt; ///< 0 in the first call
  double dt;
};

struct Result {
  double largest_rate; ///< 1/stable step
  double elastic_energy, plastic_work, viscous_work, hourglass_energy;
  std::size_t inverted; ///< n_elements if none
};

using Kernel = void (*)(const Elements &, const Material &, const LaneFunctions &, const Step &, Result &);

// Order of the numbers above. Constants of the eight-point element: V, 1/(smallest nodal mass), then, unless
// hypoelastic, the reference volume of each point. History: v, the step bound's Ω and the viscous pressure of
// the last call, then each point's. Point history: H = j⁻¹ b_e j⁻ᵀ (6 numbers, convected: C_p⁻¹ in the
// element's own coordinates) or dev τ (11, 22, 12, 13, 23); then, where there is plasticity, α and, where
// hardening is not linear, σ_y(α). The one-point element: see one_point.h.

/// Index by element (mean_dilatation, one_point), kinematics, and whether there is plasticity.
struct KernelTable {
  unsigned int n_lanes;
  Kernel kernels[2][3][2];
};

extern const KernelTable scalar_kernels, sse2_kernels, avx2_kernels, avx512_kernels;

} // namespace billet::explicit_kernels

#endif
