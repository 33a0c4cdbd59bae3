// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_BRICK_H
#define BILLET_MECHANICS_EXPLICIT_BRICK_H

#include "billet/mechanics/explicit/laws.h"
#include "billet/mechanics/explicit/nodes.h"

// The trilinear brick in terms of its modes,
//   x = a_0 + a_1 ξ + a_2 η + a_3 ζ + b_1 ηζ + b_2 ζξ + b_3 ξη + c ξηζ.

namespace billet::explicit_kernels {
namespace {

/// Vectors of the modes except the mean: a_1, a_2, a_3, b_1, b_2, b_3, c; for positions or for the
/// conjugate forces.
struct Modes {
  Real m[7][3];
};

/// Computes sums and differences of eight values over the three directions, in place.
BILLET_INLINE void hadamard(Real x[8]) {
  for (unsigned int step = 1; step < 8; step *= 2)
    for (unsigned int a = 0; a < 8; ++a)
      if ((a & step) == 0) {
        const Real low = x[a], high = x[a + step];
        x[a] = low + high;
        x[a + step] = high - low;
      }
}

constexpr unsigned int place_of_mode[7] = {1, 2, 4, 6, 5, 3, 7}; // bits ξ, η, ζ

BILLET_INLINE void compute_modes(const Real x[8][3], Modes &modes) {
  for (unsigned int i = 0; i < 3; ++i) {
    Real values[8];
    for (unsigned int a = 0; a < 8; ++a)
      values[a] = x[a][i];
    hadamard(values);
    for (unsigned int k = 0; k < 7; ++k)
      modes.m[k][i] = 0.125_r * values[place_of_mode[k]];
  }
}

/// Modes of the positions of a batch, and of its displacements in the step. The latter are set only
/// on request, in float always.
struct Motion {
  Modes x, delta;
};

#if BILLET_SINGLE

/// Gathers the modes of `scale` p.
BILLET_INLINE void gather_modes(const double *p, const double scale, const std::uint32_t *nodes,
                                Modes &modes) {
  FirstNode first;
  scale_first(p, scale, nodes, first);
  Real x[8][3];
  for (Real &component : x[0])
    component = Real{};
  for (unsigned int a = 1; a < 8; ++a)
    gather_from(first, p, scale, nodes + a * n_lanes, x[a]);
  compute_modes(x, modes);
}

/// Gathers the motion; `reference` points at the modes of the reference positions among the
/// constants.
template <bool with_step>
BILLET_INLINE void gather_motion(const Elements &, const Step &step, const std::uint32_t *nodes,
                                 const Number *reference, Motion &motion) {
  gather_modes(step.displacements, step.inverse_length, nodes, motion.x);
  gather_modes(step.velocities, step.dt * step.inverse_length, nodes, motion.delta);
  for (unsigned int m = 0; m < 7; ++m)
    for (unsigned int i = 0; i < 3; ++i)
      motion.x.m[m][i] += load(reference + (3 * m + i) * n_lanes);
}

#else

template <bool add>
BILLET_INLINE void gather_modes(const double *p, const double *q, const std::uint32_t *nodes, Modes &modes) {
  Real x[8][3];
  for (unsigned int a = 0; a < 8; ++a)
    gather<add>(p, q, nodes + a * n_lanes, x[a]);
  compute_modes(x, modes);
}

template <bool with_step>
BILLET_INLINE void gather_motion(const Elements &elements, const Step &step, const std::uint32_t *nodes,
                                 const Number *, Motion &motion) {
  gather_modes<true>(elements.reference_positions, step.displacements, nodes, motion.x);
  if constexpr (with_step) {
    gather_modes<false>(step.velocities, nullptr, nodes, motion.delta);
    for (auto &mode : motion.delta.m)
      for (Real &component : mode)
        component *= step.dt;
  }
}

#endif

/// Scatters `forces`, those of the modes, to the nodes.
BILLET_INLINE void scatter_modes(const Modes &forces, const std::uint32_t *nodes, const std::size_t n,
                                 const Step &step) {
  Real f[8][3];
  for (unsigned int i = 0; i < 3; ++i) {
    Real values[8];
    values[0] = Real{};
    for (unsigned int k = 0; k < 7; ++k)
      values[place_of_mode[k]] = 0.125_r * forces.m[k][i];
    // The transpose: node a receives Σ_k ± value, with the sign of the mode at the node.
    for (unsigned int bit = 1; bit < 8; bit *= 2)
      for (unsigned int a = 0; a < 8; ++a)
        if ((a & bit) == 0) {
          const Real mean = values[a], slope = values[a + bit];
          values[a] = mean - slope;
          values[a + bit] = mean + slope;
        }
    for (unsigned int a = 0; a < 8; ++a)
      f[a][i] = values[a];
  }
#if BILLET_SINGLE
  scatter(f, nodes, n, step.force, step.forces);
#else
  scatter(f, nodes, n, step.forces);
#endif
}

/// Returns the exact volume, 8 {[a1 a2 a3] − ([a1 b2 b3] + [b1 a2 b3] + [b1 b2 a3])/3}. It is
/// linear in the modes a1 and b1 of x, in a2 and b2 of y, and in a3 and b3 of z.
BILLET_INLINE Real compute_volume(const Modes &x, const Modes &y, const Modes &z) {
  Real a[3], b[3], t[3];
  cross(y.m[1], z.m[2], a);
  cross(y.m[4], z.m[5], b);
  for (unsigned int i = 0; i < 3; ++i)
    a[i] -= b[i] * (1._r / 3._r);
  cross(y.m[1], z.m[5], b);
  cross(y.m[4], z.m[2], t);
  return 8._r * (dot(x.m[0], a) - (1._r / 3._r) * (dot(x.m[3], b) + dot(x.m[3], t)));
}

/// Returns the volume at the modes `after` minus that at `before`. It uses their difference, so
/// there is no cancellation error.
BILLET_INLINE Real compute_volume_change(const Modes &before, const Modes &difference, const Modes &after) {
  return compute_volume(difference, after, after) +
         (compute_volume(before, difference, after) + compute_volume(before, before, difference));
}

/// Columns ∂x/∂ξ_k at the four lines along ξ_k through the Gauss points. The index is [k][line],
/// bit 0 of the line for the first of the other two directions. Also used for the conjugate forces.
struct Columns {
  Real c[3][4][3];
};

constexpr Number gauss = 0.57735026918962576451_r;

/// Modes that vary along the first and the second of the other two directions.
constexpr unsigned int varying[3][2] = {{5, 4}, {5, 3}, {4, 3}};

BILLET_INLINE void compute_columns(const Modes &x, Columns &columns) {
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i) {
      const Real first = gauss * x.m[varying[k][0]][i], second = gauss * x.m[varying[k][1]][i],
                 both = (gauss * gauss) * x.m[6][i];
      const Real low = x.m[k][i] - second, high = x.m[k][i] + second;
      const Real slope_low = first - both, slope_high = first + both;
      columns.c[k][0][i] = low - slope_low;
      columns.c[k][1][i] = low + slope_low;
      columns.c[k][2][i] = high - slope_high;
      columns.c[k][3][i] = high + slope_high;
    }
}

/// Computes the forces of the modes from those of the columns, the transpose of compute_columns().
BILLET_INLINE void collect_columns(const Columns &forces, Modes &f) {
  for (unsigned int k = 3; k < 7; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      f.m[k][i] = Real{};
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i) {
      const Real low = forces.c[k][0][i] + forces.c[k][1][i], high = forces.c[k][2][i] + forces.c[k][3][i];
      const Real slope_low = forces.c[k][1][i] - forces.c[k][0][i],
                 slope_high = forces.c[k][3][i] - forces.c[k][2][i];
      f.m[k][i] = low + high;
      f.m[varying[k][0]][i] += gauss * (slope_low + slope_high);
      f.m[varying[k][1]][i] += gauss * (high - low);
      f.m[6][i] += (gauss * gauss) * (slope_high - slope_low);
    }
}

/// Offsets of an eight-point element's constants. In float its reference modes are included.
namespace eight_point {
constexpr unsigned int volume = 0, inverse_mass = 1, modes = 2, point_volumes = is_single ? 23 : 2;
} // namespace eight_point

/// Current volume of an element, ln J̄, the change in the step, and the sum of the volumes before
/// and after it.
struct VolumeChange {
  Real now, logarithm_of_J, change, sum;
};

/// Updates the volume in float: accumulates J̄ − 1 from the change.
BILLET_INLINE VolumeChange add_volume(const Real change, const Real reference_volume, Number *history) {
  VolumeChange volume;
  const Real above_one = load(history + last::volume * n_lanes) + change / reference_volume;
  store(history + last::volume * n_lanes, above_one);
  volume.now = reference_volume + reference_volume * above_one;
  volume.logarithm_of_J = logarithm_of_one_plus(above_one);
  volume.change = change;
  volume.sum = 2._r * volume.now - change;
  return volume;
}

/// Updates the volume in double: takes the change from the volumes.
BILLET_INLINE VolumeChange compare_volume(const Real now, const Real J, Number *history) {
  VolumeChange volume;
  const Real before = load(history + last::volume * n_lanes);
  volume.now = now;
  volume.logarithm_of_J = logarithm(J);
  volume.change = now - before;
  volume.sum = now + before;
  store(history + last::volume * n_lanes, now);
  return volume;
}

/// Bulk viscosity of a brick and its effect on the stable step.
struct Damping {
  Real pressure; ///< positive in tension, Cauchy
  Real work;     ///< work of the mean of this and the last pressure in the change of volume
  Real rate;     ///< rate of the damping, ∂pressure/∂d · d-weight, see bound_rate()
};

/// Computes the bulk viscosity. The characteristic length of the brick is L² = 4/(ρ Ω) with the Ω
/// of the last call, which `history` stores. Also stores the pressure there.
BILLET_INLINE Damping compute_viscosity(const Material &material, const VolumeChange &volume, Number *history,
                                        const Number inverse_dt) {
  const Real last_omega = load(history + last::omega * n_lanes);
  const Real d = (2._r * inverse_dt) * volume.change / volume.sum;
  const Real root = square_root(last_omega);
  const Real inverse_root = 1._r / root; // √ρ L / 2
  const Real linear =
      (2._r * material.viscosity.linear * material.wave_speed * square_root(material.density)) * inverse_root;
  const Real compression = max(-d, Real{});
  const Real quadratic = (4._r * material.viscosity.quadratic * material.viscosity.quadratic) * inverse_root *
                         inverse_root * compression;
  Damping damping;
  damping.pressure = (linear + quadratic) * d;
  damping.work =
      0.5_r * (load(history + last::viscous_pressure * n_lanes) + damping.pressure) * volume.change;
  store(history + last::viscous_pressure * n_lanes, damping.pressure);
  damping.rate = 3._r * (linear + 2._r * quadratic);
  return damping;
}

/// Returns the maximum elastic stiffness per |∇v|², without stress.
inline Number max_modulus(const Material &material) {
  return 3._r * material.bulk > 2._r * material.shear ? 3._r * material.bulk : 2._r * material.shear;
}

/// Returns the minimum 1/Δt for which M − Δt C/2 − Δt² K/4 stays positive: K ≤ M ω², C ≤ M c.
BILLET_INLINE Real bound_rate(const Real omega_squared, const Real c) {
  return 0.5_r * (0.5_r * c + square_root(0.25_r * c * c + omega_squared));
}

/// Prefetches into the second-level cache: the first has no room for two batches and the work on a
/// third.
template <class T> BILLET_INLINE void prefetch(const T *p, const std::size_t n) {
  for (std::size_t k = 0; k < n; k += 64 / sizeof(T))
    __builtin_prefetch(p + k, 0, 2);
}

BILLET_INLINE void prefetch(const Elements &elements, const Step &step, const std::size_t batch,
                            const std::size_t n_batches, const bool velocities) {
  if (batch >= n_batches)
    return;
  const std::size_t n_constants = elements.layout.n_constants * n_lanes,
                    n_history = elements.layout.n_history * n_lanes;
  prefetch(elements.constants + batch * n_constants, n_constants);
  prefetch(elements.history + batch * n_history, n_history);
  const std::uint32_t *nodes = elements.nodes + batch * 8 * n_lanes;
  for (unsigned int k = 0; k < 8 * n_lanes; ++k) {
    const std::size_t place = 4 * std::size_t{nodes[k]};
    prefetch(step.displacements + place, 4);
    if constexpr (!is_single)
      prefetch(elements.reference_positions + place, 4);
    prefetch(step.forces + place, 4);
    if (velocities || is_single)
      prefetch(step.velocities + place, 4);
  }
}

/// Returns the number of distinct elements in the batch that begins with element `first`.
inline std::size_t count_elements(const Elements &elements, const std::size_t first) {
  return elements.n_elements - first < n_lanes ? elements.n_elements - first : n_lanes;
}

/// Energies of one element per lane.
struct Energies {
  Real elastic = {}, plastic = {}, viscous = {}, hourglass = {};
};

/// Sums over the batches, in double.
struct Sum {
#if BILLET_LANES == 1
  using Wide = double;
#else
  using Wide = double __attribute__((vector_size(8 * BILLET_LANES)));
#endif
  Wide lanes = {};

  /// Adds `more`; the lanes beyond n repeat an element and are ignored.
  void add(const std::size_t n, const Real more) {
#if BILLET_LANES == 1
    lanes += n == 1 ? more : Real{};
#else
    if (n == n_lanes)
      lanes += __builtin_convertvector(more, Wide);
    else
      for (std::size_t lane = 0; lane < n; ++lane)
        lanes[lane] = lanes[lane] + get(more, lane);
#endif
  }

  double sum() const {
#if BILLET_LANES == 1
    return lanes;
#else
    double total = 0.;
    for (std::size_t lane = 0; lane < n_lanes; ++lane)
      total += lanes[lane];
    return total;
#endif
  }
};

struct Totals {
  Real rate = {};
  Sum elastic, plastic, viscous, hourglass;

  void add(const std::size_t n, const Real rate_now, const Energies &more) {
    rate = max(rate, rate_now);
    elastic.add(n, more.elastic);
    plastic.add(n, more.plastic);
    viscous.add(n, more.viscous);
    hourglass.add(n, more.hourglass);
  }

  void finish(Result &result) const {
    result.max_rate = max_lane(rate);
    result.elastic_energy = elastic.sum();
    result.plastic_work = plastic.sum();
    result.viscous_work = viscous.sum();
    result.hourglass_energy = hourglass.sum();
  }
};

/// Returns ½ κ ln²J, the energy per reference volume, from κ ln J.
BILLET_INLINE Real compute_dilatation_energy(const Material &material, const Real mean_tau) {
  return mean_tau * mean_tau * (0.5_r / material.bulk);
}

/// Maximum determinant; larger ones come from numbers that are not finite, or are about to
/// overflow.
constexpr Number finite_bound = is_single ? 1e30_r : 1e300_r;

/// Stores the first bad lane of a batch in the result, unless an earlier element failed.
inline void note_failure(const Mask bad, const std::size_t first, Result &result) {
  for (std::size_t lane = 0; lane < n_lanes; ++lane)
    if (get_mask(bad, lane) && first + lane < result.inverted)
      result.inverted = first + lane;
}

} // namespace
} // namespace billet::explicit_kernels

#endif
