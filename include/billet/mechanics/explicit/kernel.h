// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_KERNEL_H
#define BILLET_MECHANICS_EXPLICIT_KERNEL_H

#include "billet/material/lane_forms.h"

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

/// Constants of the body, in the units of its numbers. `Number` is what kernels compute with.
template <class Number> struct BasicMaterial {
  Number bulk, shear;
  HardeningKind hardening_kind;
  Number yield_stress, hardening_modulus;    ///< linear; Voce
  Number saturation_stress, saturation_rate; ///< Voce
  Number prestrain, exponent, strength;      ///< power law
  const void *hardening;                     ///< the law, for LaneFunctions
  double stress_unit;                        ///< of its stresses
  Number density;
  Number wave_speed;
  Number linear_viscosity, quadratic_viscosity;
};

/// One element takes these many numbers, in batches of as many elements as there are lanes: number k of batch
/// b and lane l stands at (b n + k) n_lanes + l.
struct Layout {
  std::size_t n_constants;
  std::size_t n_history;
  std::size_t n_point_history; ///< of which for each point
};

template <class Number> struct BasicElements {
  std::size_t n_elements;
  const std::uint32_t *nodes;        ///< 8 for each element, in batches like the others; padded with the last
  const double *reference_positions; ///< stride 4
  const Number *constants;
  Number *history;
  Layout layout;
};

/// Nodal vectors are in the user's units, all else is in those of the kernel's numbers.
struct Step {
  const double *displacements, *velocities;
  double *forces;
  double inverse_dt;     ///< 0 in the first call
  double dt;             ///< in the user's units
  double inverse_length; ///< of the unit; 1 for kernels in double
  double force;          ///< the unit; 1 for kernels in double
};

/// In the units of the kernel's numbers.
struct Result {
  double largest_rate; ///< 1/stable step
  double elastic_energy, plastic_work, viscous_work, hourglass_energy;
  std::size_t inverted; ///< n_elements if none
};

template <class Number>
using Kernel = void (*)(const BasicElements<Number> &, const BasicMaterial<Number> &, const LaneFunctions &,
                        const Step &, Result &);

// Order of the numbers above. Constants of the eight-point element: V, 1/(smallest nodal mass), then, unless
// hypoelastic, the reference volume of each point. History: v, the step bound's Ω and the viscous pressure of
// the last call, then each point's. Point history: H = j⁻¹ b_e j⁻ᵀ (6 numbers, convected: C_p⁻¹ in the
// element's own coordinates) or dev τ (11, 22, 12, 13, 23); then, where there is plasticity, α and, where
// hardening is not linear, σ_y(α). Constants of the others: below.
//
// In float, where differences have to be taken before they are rounded: the modes of the reference positions
// (21 numbers) are constants, too. History: J̄ − 1 in the place of v, and of each point b_e − 1 in space up to
// a factor (6 numbers) or dev τ; then α in two parts, and σ_y(α).

/// Places of what every element keeps of its last call; its kind's own numbers follow. In float J̄ − 1 stands
/// for the volume.
namespace last {
constexpr unsigned int volume = 0, omega = 1, viscous_pressure = 2, n = 3;
} // namespace last

/// Places of the constants of elements with the mean gradient.
namespace mean_gradient {
constexpr unsigned int volume = 0, inverse_det = 1, bound = 2;
constexpr unsigned int beta = 3; ///< J̄_k = Σ_m m β_mk over the modes a and b: 3 m + k
constexpr unsigned int n = 21;
} // namespace mean_gradient

/// Those of the one-point element.
namespace one_point {
using namespace mean_gradient;
constexpr unsigned int bound_of_all = mean_gradient::n; ///< as `bound`, of the columns and the modes b, c
constexpr unsigned int hourglass_modulus = 22;          ///< largest of the hourglass strains
constexpr unsigned int metric = 23; ///< a_k·a_k, then a_2·a_3, a_3·a_1, a_1·a_2, over the largest square
constexpr unsigned int modes = 29;  ///< of the reference positions, in float
// History: that of the last call, ĥ_0 (in float ĥ itself), then the point's.
constexpr unsigned int hourglass = last::n, point = hourglass + 12;
} // namespace one_point

/// Those of the element with assumed strains.
namespace assumed_strain {
using namespace mean_gradient;
constexpr unsigned int own = mean_gradient::n; ///< J_0⁻¹ (b_1, b_2, b_3, c)_0: 3 m + k
constexpr unsigned int share = own + 12;       ///< s_jk (j, k: 12, 13, 21, 23, 31, 32)
constexpr unsigned int shear = share + 6;      ///< s θ_jk
constexpr unsigned int thinning = shear + 6;
constexpr unsigned int modes = thinning + 3; ///< of the reference positions, in float
} // namespace assumed_strain

/// Index by element (assumed_strain, mean_dilatation, one_point), law (as LaneLaw), and whether there is
/// plasticity.
template <class Number> struct KernelTable {
  unsigned int n_lanes;
  Kernel<Number> kernels[3][3][2];
};

extern const KernelTable<double> scalar_kernels, sse2_kernels, avx2_kernels, avx512_kernels;
extern const KernelTable<float> scalar_float_kernels, sse2_float_kernels, avx2_float_kernels,
    avx512_float_kernels;

} // namespace billet::explicit_kernels

#endif
