// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_BRICK_H
#define BILLET_MECHANICS_EXPLICIT_BRICK_H

#include "billet/mechanics/explicit/laws.h"

// The trilinear brick by its modes,
//   x = a_0 + a_1 ξ + a_2 η + a_3 ζ + b_1 ηζ + b_2 ζξ + b_3 ξη + c ξηζ.

namespace billet::explicit_kernels {
namespace {

/// Vectors of the modes but for the mean: a_1, a_2, a_3, b_1, b_2, b_3, c. Of positions, or of the forces
/// that belong to them.
struct Modes {
  Real m[7][3];
};

/// Sums and differences over the three directions of eight values, in place.
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

template <bool add>
BILLET_INLINE void gather_modes(const double *p, const double *q, const std::uint32_t *nodes, Modes &modes) {
  Real x[8][3];
  for (unsigned int a = 0; a < 8; ++a)
    gather<add>(p, q, nodes + a * n_lanes, x[a]);
  for (unsigned int i = 0; i < 3; ++i) {
    Real values[8];
    for (unsigned int a = 0; a < 8; ++a)
      values[a] = x[a][i];
    hadamard(values);
    for (unsigned int k = 0; k < 7; ++k)
      modes.m[k][i] = 0.125 * values[place_of_mode[k]];
  }
}

/// Displacements of the step.
BILLET_INLINE void gather_increment(const Step &step, const std::uint32_t *nodes, Modes &modes) {
  gather_modes<false>(step.velocities, nullptr, nodes, modes);
  for (auto &mode : modes.m)
    for (Real &component : mode)
      component *= step.dt;
}

/// `forces` belong to the modes.
BILLET_INLINE void scatter_modes(const Modes &forces, const std::uint32_t *nodes, const std::size_t n,
                                 double *nodal_forces) {
  Real f[8][3];
  for (unsigned int i = 0; i < 3; ++i) {
    Real values[8];
    values[0] = Real{};
    for (unsigned int k = 0; k < 7; ++k)
      values[place_of_mode[k]] = 0.125 * forces.m[k][i];
    // The transpose: node a gets Σ_k ± value, with the sign of the mode at the node.
    for (unsigned int step = 1; step < 8; step *= 2)
      for (unsigned int a = 0; a < 8; ++a)
        if ((a & step) == 0) {
          const Real mean = values[a], slope = values[a + step];
          values[a] = mean - slope;
          values[a + step] = mean + slope;
        }
    for (unsigned int a = 0; a < 8; ++a)
      f[a][i] = values[a];
  }
  scatter(f, nodes, n, nodal_forces);
}

/// Exact volume, 8 {[a1 a2 a3] − ([a1 b2 b3] + [b1 a2 b3] + [b1 b2 a3])/3}.
BILLET_INLINE Real compute_volume(const Modes &x) {
  Real a[3], b[3], t[3];
  cross(x.m[1], x.m[2], a);
  cross(x.m[4], x.m[5], b);
  for (unsigned int i = 0; i < 3; ++i)
    a[i] -= b[i] * (1. / 3.);
  cross(x.m[1], x.m[5], b);
  cross(x.m[4], x.m[2], t);
  return 8. * (dot(x.m[0], a) - (1. / 3.) * (dot(x.m[3], b) + dot(x.m[3], t)));
}

/// ∂x/∂ξ_k at the four places where a line along ξ_k crosses the Gauss points: [k][place], bit 0 of the place
/// for the first of the other two directions. Also the forces that belong to them.
struct Columns {
  Real c[3][4][3];
};

constexpr double gauss = 0.57735026918962576451;

/// Modes that vary along the other two directions, in their order (first: with the first one, second, both).
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

/// The transpose: forces of the columns to forces of the modes.
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

/// Places of what every element keeps of its last call; its kind's own numbers follow.
namespace last {
constexpr unsigned int volume = 0, omega = 1, viscous_pressure = 2, n = 3;
} // namespace last

/// Bulk viscosity of a brick and its stable step.
struct Damping {
  Real pressure; ///< positive in tension, Cauchy
  Real work;     ///< of the mean of this and the last pressure in the change of volume
  Real rate;     ///< of the damping, ∂pressure/∂d · d-weight, see bound_rate()
};

/// Characteristic length of the brick: L² = 4/(ρ Ω) with the Ω of the last call, which `history` has. Puts
/// volume and pressure there.
BILLET_INLINE Damping compute_viscosity(const Material &material, const Real volume, double *history,
                                        const double inverse_dt) {
  const Real last_volume = load(history + last::volume * n_lanes);
  const Real last_omega = load(history + last::omega * n_lanes);
  const Real change = volume - last_volume;
  const Real d = (2. * inverse_dt) * change / (volume + last_volume);
  const Real root = square_root(last_omega);
  const Real inverse_root = 1. / root; // √ρ L / 2
  const Real linear =
      (2. * material.linear_viscosity * material.wave_speed * __builtin_sqrt(material.density)) *
      inverse_root;
  const Real compression = max(-d, Real{});
  const Real quadratic = (4. * material.quadratic_viscosity * material.quadratic_viscosity) * inverse_root *
                         inverse_root * compression;
  Damping damping;
  damping.pressure = (linear + quadratic) * d;
  damping.work = 0.5 * (load(history + last::viscous_pressure * n_lanes) + damping.pressure) * change;
  store(history + last::volume * n_lanes, volume);
  store(history + last::viscous_pressure * n_lanes, damping.pressure);
  damping.rate = 3. * (linear + 2. * quadratic);
  return damping;
}

/// Largest elastic stiffness per |∇v|², without stress.
inline double max_modulus(const Material &material) {
  return 3. * material.bulk > 2. * material.shear ? 3. * material.bulk : 2. * material.shear;
}

/// 1/Δt where M − Δt C/2 − Δt² K/4 stays positive: K ≤ M ω², C ≤ M c.
BILLET_INLINE Real bound_rate(const Real omega_squared, const Real c) {
  return 0.5 * (0.5 * c + square_root(0.25 * c * c + omega_squared));
}

/// Into the second-level cache: the first has no room for two batches and the work on a third.
BILLET_INLINE void prefetch(const double *p, const std::size_t n) {
  for (std::size_t k = 0; k < n; k += 8)
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
    prefetch(elements.reference_positions + place, 4);
    prefetch(step.forces + place, 4);
    if (velocities)
      prefetch(step.velocities + place, 4);
  }
}

/// How many lanes of the batch that begins with element `first` are elements of their own.
inline std::size_t count_elements(const Elements &elements, const std::size_t first) {
  return elements.n_elements - first < n_lanes ? elements.n_elements - first : n_lanes;
}

/// Of an element, or summed over batches.
struct Energies {
  Real elastic = {}, plastic = {}, viscous = {}, hourglass = {};
};

/// Sums over the batches.
struct Totals {
  Real rate = {};
  Energies energies;

  /// The lanes beyond n repeat an element.
  void add(const std::size_t n, const Real rate_now, const Energies &more) {
    rate = max(rate, rate_now);
    add(n, more.elastic, energies.elastic);
    add(n, more.plastic, energies.plastic);
    add(n, more.viscous, energies.viscous);
    add(n, more.hourglass, energies.hourglass);
  }

  void finish(Result &result) const {
    result.largest_rate = largest_lane(rate);
    result.elastic_energy = sum_lanes(energies.elastic);
    result.plastic_work = sum_lanes(energies.plastic);
    result.viscous_work = sum_lanes(energies.viscous);
    result.hourglass_energy = sum_lanes(energies.hourglass);
  }

private:
  static void add(const std::size_t n, const Real more, Real &sum) {
    if (n == n_lanes)
      sum += more;
    else
      for (std::size_t lane = 0; lane < n; ++lane)
        set(sum, lane, get(sum, lane) + get(more, lane));
  }
};

/// ½ κ ln²J per reference volume, from κ ln J.
BILLET_INLINE Real compute_dilatation_energy(const Material &material, const Real mean_tau) {
  return mean_tau * mean_tau * (0.5 / material.bulk);
}

/// The first bad lane of a batch becomes the result's element, if none was found before.
inline void note_failure(const Mask bad, const std::size_t first, Result &result) {
  for (std::size_t lane = 0; lane < n_lanes; ++lane)
    if (get_mask(bad, lane) && first + lane < result.inverted)
      result.inverted = first + lane;
}

} // namespace
} // namespace billet::explicit_kernels

#endif
