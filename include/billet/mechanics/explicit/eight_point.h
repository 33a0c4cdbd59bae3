// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_EIGHT_POINT_H
#define BILLET_MECHANICS_EXPLICIT_EIGHT_POINT_H

#include "billet/mechanics/explicit/brick.h"

// The mean-dilatation brick. The columns of j = ∂x/∂ξ at the eight points are twelve, four in each direction.
// With Cauchy's σ = (w/det j) dev τ + p 1 the forces of a point's columns are σ cof j: since the p part
// integrates to p ∂v/∂x, mean dilatation needs no gradients of its own.

namespace billet::explicit_kernels {
namespace {

/// Where column k of point q is among its four.
constexpr unsigned int place_of_point(const unsigned int k, const unsigned int q) {
  return k == 0 ? q >> 1 : k == 1 ? (q & 1) | (q >> 1 & 2) : q & 3;
}

/// What the points of an element add up to.
struct PointSums {
  Watch watch;
  Real lambda = {}; ///< largest λ_max of w j⁻¹ j⁻ᵀ, or with det j/J̄ for w where that is larger
  Mask inadmissible = {};                  ///< det j not positive and finite
  Real distortion = {}, plastic_work = {}; ///< energies
};

/// Forces of one point, added to those of its columns.
template <class Law, bool is_plastic>
BILLET_INLINE void add_point(const Material &material, const LaneFunctions &functions, const unsigned int q,
                             const Columns &x, const Columns *delta, const Real weight, const Real pressure,
                             const Real inverse_mean_J, double *history, Columns &forces, PointSums &sums) {
  Map map;
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      map.j[k][i] = x.c[k][place_of_point(k, q)][i];
  Real stress[6], factor;
  if constexpr (is_rate_form<Law>) {
    Real d[3][3];
    Map middle;
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i) {
        d[k][i] = delta->c[k][place_of_point(k, q)][i];
        middle.j[k][i] = map.j[k][i] - 0.5 * d[k][i];
      }
    middle.complete();
    map.complete();
    sums.inadmissible |= !(middle.det > 0.);
    Law::template update<is_plastic>(material, functions, middle, d, Real{}, history, stress, sums.watch);
    factor = inverse_mean_J;
  } else {
    map.complete();
    factor = weight * map.inverse_det;
    Law::template update<is_plastic>(material, functions, map, map.det / weight, Real{}, history, stress,
                                     sums.watch);
  }
  sums.inadmissible |= !(map.det > 0. && map.det < 1e300);
  const Real volume = is_rate_form<Law> ? factor * map.det : weight; // as the forces have it
  sums.distortion += volume * sums.watch.distortion;
  if constexpr (is_plastic)
    sums.plastic_work += volume * sums.watch.plastic_work;
  for (unsigned int k = 0; k < 6; ++k)
    stress[k] = factor * stress[k] + (k < 3 ? pressure : Real{});
  for (unsigned int k = 0; k < 3; ++k) {
    Real f[3];
    multiply(stress, map.cofactor[k], f);
    for (unsigned int i = 0; i < 3; ++i)
      forces.c[k][place_of_point(k, q)][i] += f[i];
  }
  Real metric[6];
  map.compute_metric(metric);
  sums.lambda = max(sums.lambda, bound_eigenvalue(metric) * (max(factor, inverse_mean_J) * map.inverse_det));
}

template <class Law, bool is_plastic>
void advance_eight_point(const Elements &elements, const Material &material, const LaneFunctions &functions,
                         const Step &step, Result &result) {
  constexpr bool is_rate = is_rate_form<Law>;
  const std::size_t n_batches = (elements.n_elements + n_lanes - 1) / n_lanes;
  const Layout &layout = elements.layout;
  Totals totals;
  result.inverted = elements.n_elements;
  for (std::size_t batch = 0; batch < n_batches; ++batch) {
    prefetch(elements, step, batch + 2, n_batches, is_rate);
    const std::uint32_t *nodes = elements.nodes + batch * 8 * n_lanes;
    const double *constants = elements.constants + batch * layout.n_constants * n_lanes;
    double *history = elements.history + batch * layout.n_history * n_lanes;

    Modes modes;
    gather_modes<true>(elements.reference_positions, step.displacements, nodes, modes);
    const Real volume = compute_volume(modes);
    Columns x, delta, forces;
    compute_columns(modes, x);
    if constexpr (is_rate) {
      gather_increment(step, nodes, modes);
      compute_columns(modes, delta);
    }
    for (auto &direction : forces.c)
      for (auto &column : direction)
        for (Real &component : column)
          component = Real{};

    const Real J = volume / load(constants);
    const Real inverse_J = 1. / J;
    const Real mean_tau = material.bulk * logarithm(J);
    const Damping damping = compute_viscosity(material, volume, history, step.inverse_dt);
    const Real pressure = mean_tau * inverse_J + damping.pressure;
    PointSums sums;
    for (unsigned int q = 0; q < 8; ++q)
      add_point<Law, is_plastic>(material, functions, q, x, &delta,
                                 is_rate ? Real{} : load(constants + (2 + q) * n_lanes), pressure, inverse_J,
                                 history + (last::n + q * layout.n_point_history) * n_lanes, forces, sums);
    collect_columns(forces, modes);
    const std::size_t first = batch * n_lanes;
    const std::size_t n = count_elements(elements, first);
    scatter_modes(modes, nodes, n, step.forces);

    const Real omega = sums.lambda * load(constants + n_lanes);
    store(history + last::omega * n_lanes, omega);
    const Real modulus = max_modulus(material) + 4. * abs(mean_tau) + 3. * sums.watch.mises;
    Energies energies;
    energies.elastic = sums.distortion + load(constants) * compute_dilatation_energy(material, mean_tau);
    energies.plastic = sums.plastic_work;
    energies.viscous = damping.work;
    totals.add(n, bound_rate(modulus * omega, damping.rate * J * omega), energies);
    const Mask bad = sums.inadmissible | sums.watch.failed;
    if (__builtin_expect(any(bad), 0))
      note_failure(bad, first, result);
  }
  totals.finish(result);
}

} // namespace
} // namespace billet::explicit_kernels

#endif
