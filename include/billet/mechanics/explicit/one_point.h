// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_ONE_POINT_H
#define BILLET_MECHANICS_EXPLICIT_ONE_POINT_H

#include "billet/mechanics/explicit/mean_gradient.h"
#include "billet/mechanics/hourglass_energy.h"

// The one-point brick. It stores the energy V ψ(F̄) of the mean deformation gradient F̄ = (1/V) ∫ F
// dV, plus that of the hourglass strains. These are ĥ = J̄⁻¹ (b_1, b_2, b_3, c) − ĥ_0 with J̄ = F̄
// (a_1, a_2, a_3)_0. They are zero in linear fields and invariant under rotations. doc/theory.md
// has the derivation.

namespace billet::explicit_kernels {
namespace {

using HourglassModuli = hourglass::Moduli<Number>;
using HourglassMetric = hourglass::Metric<Real>;

/// Hourglass strains at the end of a step before plastic flow: ĉ = J̄⁻¹ (b_1, b_2, b_3, c), ĥ,
/// their stresses and energy.
struct HourglassTrial {
  Real c[4][3], h[4][3], s[4][3];
  HourglassMetric metric;
  Real density; ///< energy per reference volume
};

/// Computes the hourglass strains. In float they advance by the step: ĉ ← ĉ + J̄⁻¹ {Δ(b_1, b_2,
/// b_3, c) − ΔJ̄ ĉ}, and likewise ĥ, which the history stores.
BILLET_INLINE void compute_hourglass(const HourglassModuli &moduli, const Motion &motion,
                                     const MeanMotion &mean, const Number *constants, Number *history,
                                     HourglassTrial &trial) {
  for (unsigned int k = 0; k < 3; ++k) {
    trial.metric.square[k] = load(constants + (one_point::metric + k) * n_lanes);
    trial.metric.product[k] = load(constants + (one_point::metric + 3 + k) * n_lanes);
  }
  trial.metric.complete([](const Real x) { return 1._r / x; });
  for (unsigned int m = 0; m < 4; ++m)
    if constexpr (is_single) {
      Real b[3], c[3], y[3];
      for (unsigned int i = 0; i < 3; ++i)
        b[i] = motion.x.m[3 + m][i] - motion.delta.m[3 + m][i];
      for (unsigned int k = 0; k < 3; ++k)
        c[k] = mean.before.inverse_det * dot(mean.before.cofactor[k], b);
      for (unsigned int i = 0; i < 3; ++i)
        y[i] = motion.delta.m[3 + m][i] - (mean.d[0][i] * c[0] + mean.d[1][i] * c[1] + mean.d[2][i] * c[2]);
      for (unsigned int k = 0; k < 3; ++k) {
        const Real change = mean.now.inverse_det * dot(mean.now.cofactor[k], y);
        Number *strain = history + (one_point::hourglass + 3 * m + k) * n_lanes;
        trial.c[m][k] = c[k] + change;
        trial.h[m][k] = load(strain) + change;
        store(strain, trial.h[m][k]);
      }
    } else
      for (unsigned int k = 0; k < 3; ++k) {
        trial.c[m][k] = mean.now.inverse_det * dot(mean.now.cofactor[k], motion.x.m[3 + m]);
        trial.h[m][k] = trial.c[m][k] - load(history + (one_point::hourglass + 3 * m + k) * n_lanes);
      }
  trial.density = hourglass::respond(moduli, trial.metric, trial.h, trial.s);
}

/// Applies plastic flow: it scales the elastic part of the hourglass strains by the factor `share`
/// of the point's stress, (X8). If the history stores ĥ_0, the remainder is added to it.
BILLET_INLINE void flow(const Real share, Number *history, HourglassTrial &trial) {
  if (!any(share < 1._r))
    return;
  const Real lost = 1._r - share;
  trial.density *= share * share;
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int k = 0; k < 3; ++k) {
      Number *shift = history + (one_point::hourglass + 3 * m + k) * n_lanes;
      if constexpr (!is_single)
        store(shift, load(shift) + lost * trial.h[m][k]);
      trial.h[m][k] *= share;
      if constexpr (is_single)
        store(shift, trial.h[m][k]);
      trial.s[m][k] *= share;
    }
}

/// Adds the forces of the modes b and c, and those of J̄'s columns to `mean_forces`.
BILLET_INLINE void add_hourglass(const Real volume, const HourglassTrial &hourglass, const Map &map,
                                 Modes &forces, Real mean_forces[3][3]) {
  const Real factor = volume * map.inverse_det;
  for (unsigned int m = 0; m < 4; ++m) {
    const Real *s = hourglass.s[m];
    for (unsigned int i = 0; i < 3; ++i) {
      const Real t =
          factor * (map.cofactor[0][i] * s[0] + map.cofactor[1][i] * s[1] + map.cofactor[2][i] * s[2]);
      forces.m[3 + m][i] += t;
      for (unsigned int k = 0; k < 3; ++k)
        mean_forces[k][i] -= t * hourglass.c[m][k];
    }
  }
}

/// Returns the bound (X12) of the stiffness per volume of the columns and of the modes b and c.
/// `of_mean` is that of the mean gradient, `modulus` that of the hourglass strains. `metric` is
/// J̄⁻¹ J̄⁻ᵀ, and `eigenvalue` a bound of its eigenvalues.
BILLET_INLINE Real bound_stiffness(const HourglassTrial &hourglass, const Real of_mean, const Real metric[6],
                                   const Real eigenvalue, const Real modulus) {
  const auto &own = hourglass.metric;
  Real bound{}, c2{}, h2 = dot(hourglass.h[3], hourglass.h[3]);
  for (unsigned int m = 0; m < 3; ++m) {
    const unsigned int i = (m + 1) % 3, j = (m + 2) % 3;
    const Real twist = own.square[m] * (own.inverse_square[i] + own.inverse_square[j]);
    const Real weight = square_root(twist), *h = hourglass.h[m];
    const Real mi = weight * abs(metric[symmetric_index[m][i]]),
               mj = weight * abs(metric[symmetric_index[m][j]]), ij = abs(metric[symmetric_index[i][j]]);
    bound = max(max(bound, twist * metric[m] + mi + mj), max(metric[i] + mi + ij, metric[j] + mj + ij));
    h2 += twist * (h[m] * h[m]) + h[i] * h[i] + h[j] * h[j];
  }
  bound = max(bound, eigenvalue); // fourth mode
  for (unsigned int m = 0; m < 4; ++m)
    c2 += dot(hourglass.c[m], hourglass.c[m]);
  const Real c = square_root(c2), turning = square_root(h2 * bound * eigenvalue);
  return max(of_mean + modulus * (bound * (c + c2) + turning * (1._r + 2._r * c)),
             modulus * (bound * (1._r + c) + turning));
}

template <class Law, bool is_plastic>
BILLET_INLINE void update_mean(const Material &material, const LaneFunctions &functions,
                               const MeanMotion &mean, const Real hourglass, Number *history, Real dev_tau[6],
                               Watch &watch) {
  if constexpr (is_rate_form<Law>) {
    Map middle;
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        middle.j[k][i] = mean.now.j[k][i] - 0.5_r * mean.d[k][i];
    middle.complete();
    watch.failed |= !(middle.det > 0._r);
    Law::template update<is_plastic>(material, functions, middle, mean.d, hourglass, history, dev_tau, watch);
  } else if constexpr (is_single) {
    Strain strain;
    strain.advance(mean.before, mean.d, history);
    Law::template update<is_plastic>(material, functions, strain, hourglass, history, dev_tau, watch);
  } else
    Law::template update<is_plastic>(material, functions, mean.now, mean.J, hourglass, history, dev_tau,
                                     watch);
}

template <class Law, bool is_plastic>
BILLET_INLINE void advance_one_point_batch(const Elements &elements, const Material &material,
                                           const LaneFunctions &functions, const Step &step,
                                           const HourglassModuli &moduli, const std::size_t batch,
                                           Totals &totals, Result &result) {
  const Layout &layout = elements.layout;
  const std::uint32_t *nodes = elements.nodes + batch * 8 * n_lanes;
  const Number *constants = elements.constants + batch * layout.n_constants * n_lanes;
  Number *history = elements.history + batch * layout.n_history * n_lanes;

  Motion motion;
  gather_motion<is_rate_form<Law>>(elements, step, nodes, constants + one_point::modes * n_lanes, motion);
  MeanMotion mean;
  compute_mean_motion<is_rate_form<Law>>(motion, constants, mean);
  const Map &map = mean.now;
  const Real J = mean.J;
  const Real reference_volume = load(constants + one_point::volume * n_lanes);
  Watch watch;
  VolumeChange volume;
  if constexpr (is_single) {
    watch.failed |= !(mean.before.det > 0._r);
    const Real scale = reference_volume * load(constants + one_point::inverse_det * n_lanes);
    volume = add_volume(scale * compute_change(mean), reference_volume, history);
  } else
    volume = compare_volume(reference_volume * J, J, history);
  Real stress[6], metric[6];
  Number *point_history = history + one_point::point * n_lanes;
  HourglassTrial hourglass;
  compute_hourglass(moduli, motion, mean, constants, history, hourglass);
  update_mean<Law, is_plastic>(material, functions, mean, (6._r * material.shear) * hourglass.density,
                               point_history, stress, watch);
  if constexpr (is_plastic)
    flow(watch.share, history, hourglass);
  map.compute_metric(metric);
  for (Real &component : metric)
    component *= map.inverse_det * map.inverse_det;
  const Real eigenvalue = bound_eigenvalue(metric);
  const Real omega = reference_volume * eigenvalue * load(constants + one_point::bound * n_lanes);

  const Real mean_tau = material.bulk * volume.logarithm_of_J;
  const Damping damping = compute_viscosity(material, volume, history, static_cast<Number>(step.inverse_dt));
  store(history + last::omega * n_lanes, omega);
  const Real factor = reference_volume * map.inverse_det, pressure = mean_tau + J * damping.pressure;
  for (unsigned int k = 0; k < 6; ++k)
    stress[k] = factor * (stress[k] + (k < 3 ? pressure : Real{}));
  Real mean_forces[3][3];
  for (unsigned int k = 0; k < 3; ++k)
    multiply(stress, map.cofactor[k], mean_forces[k]);

  Modes forces{};
  add_hourglass(reference_volume, hourglass, map, forces, mean_forces);
  for (unsigned int m = 0; m < 6; ++m)
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int k = 0; k < 3; ++k)
        forces.m[m][i] += mean_forces[k][i] * load(constants + (one_point::beta + 3 * m + k) * n_lanes);
  const std::size_t first = batch * n_lanes;
  const std::size_t n = count_elements(elements, first);
  scatter_modes(forces, nodes, n, step);

  const Real modulus = max_modulus(material) + 4._r * abs(mean_tau) + 3._r * watch.mises;
  const Real elastic = watch.distortion + compute_dilatation_energy(material, mean_tau);
  const Energies energies{reference_volume * elastic, reference_volume * watch.plastic_work, damping.work,
                          reference_volume * hourglass.density};
  const Real stiffness = bound_stiffness(hourglass, modulus * eigenvalue, metric, eigenvalue,
                                         load(constants + one_point::hourglass_modulus * n_lanes));
  const Real per_mass = reference_volume * load(constants + one_point::bound_of_all * n_lanes);
  totals.add(n, bound_rate(per_mass * stiffness, damping.rate * J * omega), energies);
  const Mask bad = watch.failed | !(map.det > 0._r && map.det < finite_bound);
  if (__builtin_expect(any(bad), 0))
    note_failure(bad, first, result);
}

template <class Law, bool is_plastic>
void advance_one_point(const Elements &elements, const Material &material, const LaneFunctions &functions,
                       const Step &step, Result &result) {
  const std::size_t n_batches = (elements.n_elements + n_lanes - 1) / n_lanes;
  const HourglassModuli moduli(material.bulk, material.shear);
  Totals totals;
  result.inverted = elements.n_elements;
  for (std::size_t batch = 0; batch < n_batches; ++batch) {
    prefetch(elements, step, batch + 2, n_batches, is_rate_form<Law>);
    advance_one_point_batch<Law, is_plastic>(elements, material, functions, step, moduli, batch, totals,
                                             result);
  }
  totals.finish(result);
}

} // namespace
} // namespace billet::explicit_kernels

#endif
