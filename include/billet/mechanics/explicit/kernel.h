// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_KERNEL_H
#define BILLET_MECHANICS_EXPLICIT_KERNEL_H

#include "billet/material/lane_forms.h"
#include "billet/mechanics/lane_element.h"

#include <cstddef>
#include <cstdint>

// Interface between ExplicitBlock and its kernels: plain numbers and pointers only. A kernel is
// compiled with instructions that not every processor supports. If it instantiated an inline
// function of the standard library, the linker might keep that copy for the whole program.

namespace billet::explicit_kernels {

/// Plastic flow of one lane in a step, in the user's units.
struct LaneFlow {
  double strain;       ///< Δα ≥ 0
  double yield_stress; ///< at the end of the step, at rest
  double flow_stress;  ///< at the end of the step
  double plastic_work; ///< of the step, per volume
};

/// Callbacks of a kernel for one lane at a time, where there is no vectorised form.
struct LaneFunctions {
  /// Solves q − m Δα − σ_y(α + Δα) = 0 for the Δα > 0; `yield_stress` becomes σ_y(α + Δα).
  double (*harden)(const void *hardening, double q, double m, double alpha, double &yield_stress);
  /// Solves q − m Δα = flow stress for the Δα > 0 of a step of dt, and advances the flow stress'
  /// `state`, see FlowStress.
  LaneFlow (*flow)(const void *hardening, double q, double m, double alpha, double dt, double *state);
  /// Returns σ_y(α), at rest; `slope` becomes its derivative.
  double (*yield_stress)(const void *hardening, double alpha, double &slope);
  /// Computes dev ln b and tr ln b / 3 of a symmetric b (11, 22, 33, 12, 13, 23). Returns false if
  /// b is not positive definite.
  bool (*logarithm)(const double *b, double *deviator, double &mean);
};

// The constants of the body and of the step are in the kernel's units. `Number` is the number type
// of the kernel.

/// Parameters of hardening laws. Those of other laws are not set.
template <class Number> struct BasicHardening {
  HardeningKind kind;
  Number yield_stress, modulus;              ///< linear; Voce
  Number saturation_stress, saturation_rate; ///< Voce
  Number prestrain, exponent, strength;      ///< power law
  const void *flow_stress;                   ///< for LaneFunctions
  unsigned int n_state;                      ///< count of numbers of its state
};

/// Parameters of the rate factor in a step.
template <class Number> struct BasicRate {
  RateKind kind;              ///< other: the flow stress as a whole is computed lane by lane
  Number exponent;            ///< p
  Number reference_increment; ///< D Δt of the step: the Δα at which the rate factor is 2
  double dt;                  ///< of the step, in the user's units
};

/// Factors of the bulk viscosity.
template <class Number> struct BasicViscosity { Number linear, quadratic; };

template <class Number> struct BasicMaterial {
  Number bulk, shear;
  BasicHardening<Number> hardening;
  BasicRate<Number> rate;
  double stress_unit; ///< unit of the kernel's stresses
  Number density;
  Number wave_speed;
  BasicViscosity<Number> viscosity;
};

/// Count of numbers per element, stored in batches of as many elements as there are lanes. Number k
/// of batch b and lane l is at (b n + k) n_lanes + l.
struct Layout {
  std::size_t n_constants;
  std::size_t n_history;
  std::size_t n_point_history; ///< part of n_history for each point
};

template <class Number> struct BasicElements {
  std::size_t n_elements;
  /// 8 for each element, in batches as below; padded with the last element.
  const std::uint32_t *nodes;
  const double *reference_positions; ///< stride 4
  const Number *constants;
  Number *history;
  Layout layout;
};

/// Input and output of a step. Nodal vectors are in the user's units, everything else is in the
/// kernel's units.
struct Step {
  const double *displacements, *velocities;
  double *forces;
  double inverse_dt;     ///< 0 in the first call
  double dt;             ///< in the user's units
  double inverse_length; ///< 1/unit of length; 1 for kernels in double
  double force;          ///< unit of force; 1 for kernels in double
};

/// Results of a step, in the kernel's units.
struct Result {
  double max_rate; ///< 1/stable step
  double elastic_energy, plastic_work, viscous_work, hourglass_energy;
  std::size_t inverted; ///< n_elements if none
};

template <class Number>
using Kernel = void (*)(const BasicElements<Number> &, const BasicMaterial<Number> &, const LaneFunctions &,
                        const Step &, Result &);

// Order of these numbers. Constants of the eight-point element: V, 1/(smallest nodal mass), then,
// unless hypoelastic, the reference volume of each point. History: v, the step bound's Ω and the
// viscous pressure of the last call, then the history of each point.
//
// Point history: H = j⁻¹ b_e j⁻ᵀ (6 numbers, convected: C_p⁻¹ in the element's own coordinates) or
// dev τ (11, 22, 12, 13, 23). With plasticity follow α, unless hardening is linear, σ_y(α), and the
// state of the flow stress, in the user's units. The constants of the other elements are listed
// below.
//
// In float, differences must be formed before rounding, so the modes of the reference positions (21
// numbers) are constants, too. The history has J̄ − 1 instead of v. Each point has spatial b_e − 1
// up to a factor (6 numbers) or dev τ. Then follow α in two parts, σ_y(α), and each number of the
// flow stress' state in two parts.

/// Offsets of the data of the last call that every element stores; data of its kind follow. In
/// float J̄ − 1 replaces the volume.
namespace last {
constexpr unsigned int volume = 0, omega = 1, viscous_pressure = 2, n = 3;
} // namespace last

/// Offsets of the constants of elements with the mean gradient.
namespace mean_gradient {
constexpr unsigned int volume = 0, inverse_det = 1, bound = 2;
constexpr unsigned int beta = 3; ///< J̄_k = Σ_m m β_mk over the modes a and b: 3 m + k
constexpr unsigned int n = 21;
} // namespace mean_gradient

/// Offsets of the data of the one-point element.
namespace one_point {
using namespace mean_gradient;
/// Like `bound`, for the columns and the modes b, c.
constexpr unsigned int bound_of_all = mean_gradient::n;
/// Maximum modulus of the hourglass strains.
constexpr unsigned int hourglass_modulus = 22;
/// a_k·a_k, then a_2·a_3, a_3·a_1, a_1·a_2, over the maximum square.
constexpr unsigned int metric = 23;
constexpr unsigned int modes = 29; ///< modes of the reference positions, in float
// History: data of the last call, ĥ_0 (in float ĥ itself), then the history of the point.
constexpr unsigned int hourglass = last::n, point = hourglass + 12;
} // namespace one_point

/// Offsets of the constants of the assumed-strain element.
namespace assumed_strain {
using namespace mean_gradient;
constexpr unsigned int own = mean_gradient::n; ///< J_0⁻¹ (b_1, b_2, b_3, c)_0: 3 m + k
constexpr unsigned int share = own + 12;       ///< s_jk (j, k: 12, 13, 21, 23, 31, 32)
constexpr unsigned int shear = share + 6;      ///< s θ_jk
constexpr unsigned int thinning = shear + 6;
constexpr unsigned int modes = thinning + 3; ///< modes of the reference positions, in float
} // namespace assumed_strain

/// Table of kernels, indexed by LaneElement, LaneLaw, and whether there is plasticity.
template <class Number> struct KernelTable {
  unsigned int n_lanes;
  Kernel<Number> kernels[n_lane_elements][n_lane_laws][2];
};

/// Returns a kernel of the table; null if it has none.
template <class Number>
Kernel<Number> find_kernel(const KernelTable<Number> &table, const LaneElement element, const LaneLaw law,
                           const bool has_plasticity) {
  const auto i = static_cast<unsigned int>(element), j = static_cast<unsigned int>(law);
  return i < n_lane_elements && j < n_lane_laws ? table.kernels[i][j][has_plasticity ? 1 : 0] : nullptr;
}

extern const KernelTable<double> scalar_kernels, sse2_kernels, avx2_kernels, avx512_kernels;
extern const KernelTable<float> scalar_float_kernels, sse2_float_kernels, avx2_float_kernels,
    avx512_float_kernels;

} // namespace billet::explicit_kernels

#endif
