// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_EIGHT_POINT_H
#define BILLET_MECHANICS_EXPLICIT_EIGHT_POINT_H

#include "billet/mechanics/explicit/brick.h"

// The mean-dilatation brick. The eight points have twelve columns of j = ∂x/∂ξ, four in each
// direction. With Cauchy's σ = (w/det j) dev τ + p 1 the forces of a point's columns are σ cof j.
// Since the p part integrates to p ∂v/∂x, mean dilatation needs no gradients of its own.

namespace billet::explicit_kernels {
namespace {

/// Returns the index of column k of point q among the four of its direction.
constexpr unsigned int place_of_point(const unsigned int k, const unsigned int q) {
  return k == 0 ? q >> 1 : k == 1 ? (q & 1) | (q >> 1 & 2) : q & 3;
}

/// Sums and maxima over the points of an element.
struct PointSums {
  Watch watch;
  Real lambda = {}; ///< largest λ_max of w j⁻¹ j⁻ᵀ, or with det j/J̄ for w where that is larger
  Mask inadmissible = {};                  ///< det j not positive and finite
  Real distortion = {}, plastic_work = {}; ///< energies
};

/// Gets the columns of an element at a point.
BILLET_INLINE void get_columns(const Columns &columns, const unsigned int q, Real j[3][3]) {
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      j[k][i] = columns.c[k][place_of_point(k, q)][i];
}

/// Columns of positions and of the step's displacements, see Motion.
struct MotionColumns {
  Columns x, delta;
};

/// Computes the stress dev τ of a point from the law, and completes `map`. Returns the factor that
/// converts it to Cauchy's stress times the weight of the Jacobian. This is reference_volume/det j
/// with the point's share of the volume, or 1/J̄ for a rate form.
template <class Law, bool is_plastic>
BILLET_INLINE Real compute_stress(const Material &material, const LaneFunctions &functions,
                                  const unsigned int q, const MotionColumns &columns, const Number *weights,
                                  const Real inverse_mean_J, Number *history, Map &map, Real stress[6],
                                  PointSums &sums, Real &volume) {
  Real d[3][3];
  get_columns(columns.x, q, map.j);
  if constexpr (is_rate_form<Law> || is_single)
    get_columns(columns.delta, q, d);
  if constexpr (is_rate_form<Law>) {
    Map middle;
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        middle.j[k][i] = map.j[k][i] - 0.5_r * d[k][i];
    middle.complete();
    map.complete();
    sums.inadmissible |= !(middle.det > 0._r);
    Law::template update<is_plastic>(material, functions, middle, d, Real{}, history, stress, sums.watch);
    volume = inverse_mean_J * map.det;
    return inverse_mean_J;
  } else {
    volume = load(weights + q * n_lanes);
    if constexpr (is_single) {
      Map before;
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int i = 0; i < 3; ++i)
          before.j[k][i] = map.j[k][i] - d[k][i];
      before.complete();
      sums.inadmissible |= !(before.det > 0._r);
      Strain strain;
      strain.advance(before, d, history);
      map.complete();
      Law::template update<is_plastic>(material, functions, strain, Real{}, history, stress, sums.watch);
    } else {
      map.complete();
      Law::template update<is_plastic>(material, functions, map, map.det / volume, Real{}, history, stress,
                                       sums.watch);
    }
    return volume * map.inverse_det;
  }
}

/// Adds the forces of one point to those of its columns.
template <class Law, bool is_plastic>
BILLET_INLINE void add_point(const Material &material, const LaneFunctions &functions, const unsigned int q,
                             const MotionColumns &columns, const Number *weights, const Real pressure,
                             const Real inverse_mean_J, Number *history, Columns &forces, PointSums &sums) {
  Map map;
  Real stress[6], volume; // the volume consistent with the forces
  const Real factor = compute_stress<Law, is_plastic>(material, functions, q, columns, weights,
                                                      inverse_mean_J, history, map, stress, sums, volume);
  sums.inadmissible |= !(map.det > 0._r && map.det < finite_bound);
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

BILLET_INLINE VolumeChange compute_volumes(const Motion &motion, const Real reference_volume,
                                           Number *history) {
  if constexpr (is_single) {
    Modes before;
    for (unsigned int m = 0; m < 6; ++m)
      for (unsigned int i = 0; i < 3; ++i)
        before.m[m][i] = motion.x.m[m][i] - motion.delta.m[m][i];
    return add_volume(compute_volume_change(before, motion.delta, motion.x), reference_volume, history);
  } else {
    const Real volume = compute_volume(motion.x, motion.x, motion.x);
    return compare_volume(volume, volume / reference_volume, history);
  }
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
    const Number *constants = elements.constants + batch * layout.n_constants * n_lanes;
    Number *history = elements.history + batch * layout.n_history * n_lanes;

    Motion motion;
    gather_motion<is_rate>(elements, step, nodes, constants + eight_point::modes * n_lanes, motion);
    const Real reference_volume = load(constants);
    const VolumeChange volume = compute_volumes(motion, reference_volume, history);
    MotionColumns columns;
    Columns forces;
    compute_columns(motion.x, columns.x);
    if constexpr (is_rate || is_single)
      compute_columns(motion.delta, columns.delta);
    for (auto &direction : forces.c)
      for (auto &column : direction)
        for (Real &component : column)
          component = Real{};

    const Real J = volume.now / reference_volume;
    const Real inverse_J = 1._r / J;
    const Real mean_tau = material.bulk * volume.logarithm_of_J;
    const Damping damping =
        compute_viscosity(material, volume, history, static_cast<Number>(step.inverse_dt));
    const Real pressure = mean_tau * inverse_J + damping.pressure;
    PointSums sums;
    for (unsigned int q = 0; q < 8; ++q)
      add_point<Law, is_plastic>(material, functions, q, columns,
                                 constants + eight_point::point_volumes * n_lanes, pressure, inverse_J,
                                 history + (last::n + q * layout.n_point_history) * n_lanes, forces, sums);
    Modes nodal;
    collect_columns(forces, nodal);
    const std::size_t first = batch * n_lanes;
    const std::size_t n = count_elements(elements, first);
    scatter_modes(nodal, nodes, n, step);

    const Real omega = sums.lambda * load(constants + eight_point::inverse_mass * n_lanes);
    store(history + last::omega * n_lanes, omega);
    const Real modulus = max_modulus(material) + 4._r * abs(mean_tau) + 3._r * sums.watch.mises;
    Energies energies;
    energies.elastic = sums.distortion + reference_volume * compute_dilatation_energy(material, mean_tau);
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
