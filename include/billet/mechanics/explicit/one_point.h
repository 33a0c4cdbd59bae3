// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_ONE_POINT_H
#define BILLET_MECHANICS_EXPLICIT_ONE_POINT_H

#include "billet/mechanics/explicit/mean_gradient.h"

// The one-point brick: stored energy V ψ(F̄) of the mean deformation gradient F̄ = (1/V) ∫ F dV, plus that of
// the deformation which F̄ does not see, ĥ = J̄⁻¹ (b_1, b_2, b_3, c) − ĥ_0 with J̄ = F̄ (a_1, a_2, a_3)_0: zero
// in linear fields, unchanged by rotations. doc/theory.md has the derivation.

namespace billet::explicit_kernels {
namespace {

/// Stress-like numbers of the hourglass strains `h` (of b_1, b_2, b_3, c, in the element's own directions),
/// per volume, and the energy per volume.
struct HourglassModuli {
  Number plane, coupling; ///< E/(1 − ν²)/3, and ν times that
  Number shear, axial;    ///< G/3, E/9
  Number bending_bound;   ///< E/(1 − ν)/3

  explicit HourglassModuli(const Material &material) {
    const Number K = material.bulk, G = material.shear;
    const Number E = 9._r * K * G / (3._r * K + G), nu = (3._r * K - 2._r * G) / (6._r * K + 2._r * G);
    plane = E / (1._r - nu * nu) / 3._r;
    coupling = nu * plane;
    shear = G / 3._r;
    axial = E / 9._r;
    bending_bound = E / (1._r - nu) / 3._r;
  }

  /// Bending stretches two edges linearly along the third direction; torsion shears linearly.
  BILLET_INLINE Real respond(const Real h[4][3], const Real ratio[6], Real s[4][3]) const {
    for (unsigned int i = 0; i < 3; ++i) {
      const unsigned int j = (i + 1) % 3, k = (i + 2) % 3; // linear along i: h_k has (i, j), h_j has (i, k)
      s[k][j] = plane * h[k][j] + coupling * h[j][k];
      s[j][k] = plane * h[j][k] + coupling * h[k][j];
      s[3][i] = axial * h[3][i];
    }
    const Real g12 = shear * (h[0][0] * ratio[0] + h[1][1] * ratio[2]),
               g13 = shear * (h[0][0] * ratio[1] + h[2][2] * ratio[4]),
               g23 = shear * (h[1][1] * ratio[3] + h[2][2] * ratio[5]);
    s[0][0] = g12 * ratio[0] + g13 * ratio[1];
    s[1][1] = g12 * ratio[2] + g23 * ratio[3];
    s[2][2] = g13 * ratio[4] + g23 * ratio[5];
    Real energy{};
    for (unsigned int m = 0; m < 4; ++m)
      energy += 0.5_r * dot(h[m], s[m]);
    return energy;
  }

  /// Largest stiffness of y in h = J̄⁻¹ y per volume, from `metric` = J̄⁻¹ J̄⁻ᵀ and a bound of its eigenvalues.
  BILLET_INLINE Real bound(const Real metric[6], const Real eigenvalue, const Real ratio[6]) const {
    const Real m0 = metric[0], m1 = metric[1], m2 = metric[2];
    const Real o0 = m0 * ratio[0] * ratio[1], o1 = m1 * ratio[2] * ratio[3], o2 = m2 * ratio[4] * ratio[5];
    const Real g12 = m0 * ratio[0] * ratio[0] + m1 * ratio[2] * ratio[2],
               g13 = m0 * ratio[1] * ratio[1] + m2 * ratio[4] * ratio[4],
               g23 = m1 * ratio[3] * ratio[3] + m2 * ratio[5] * ratio[5];
    return bending_bound * eigenvalue + shear * max(max(g12 + o0 + o1, g13 + o0 + o2), g23 + o1 + o2);
  }
};

/// Of a step's end before plastic flow: ĉ = J̄⁻¹ (b_1, b_2, b_3, c), ĥ, and what they store.
struct HourglassTrial {
  Real c[4][3], h[4][3], s[4][3], ratio[6];
  Real density; ///< energy per reference volume, the scene's factor counted
};

/// In float from the step: ĉ ← ĉ + J̄⁻¹ {Δ(b_1, b_2, b_3, c) − ΔJ̄ ĉ}, and so ĥ, which the history has.
BILLET_INLINE void compute_hourglass(const Material &material, const HourglassModuli &moduli,
                                     const Motion &motion, const MeanMotion &mean, const Number *constants,
                                     Number *history, HourglassTrial &trial) {
  for (unsigned int k = 0; k < 6; ++k)
    trial.ratio[k] = load(constants + (one_point::ratios + k) * n_lanes);
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
  trial.density = material.hourglass_stiffness * moduli.respond(trial.h, trial.ratio, trial.s);
}

/// Plastic flow leaves the `share` of the hourglass strains' elastic part that it leaves of the point's
/// stress, (M33): ĥ_0 takes the rest, where the history has that.
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

/// Forces of modes b and c, and those of J̄'s columns added to `mean_forces`. Returns a bound of their
/// stiffness.
BILLET_INLINE Real add_hourglass(const Material &material, const HourglassModuli &moduli,
                                 const HourglassTrial &hourglass, const Map &map, const Real metric[6],
                                 const Real eigenvalue, const Number *constants, Modes &forces,
                                 Real mean_forces[3][3]) {
  const Real total = material.hourglass_stiffness * load(constants + one_point::volume * n_lanes);
  const Real factor = total * map.inverse_det;
  Real c2{}, h2{};
  for (unsigned int m = 0; m < 4; ++m) {
    const Real *c = hourglass.c[m], *h = hourglass.h[m], *s = hourglass.s[m];
    c2 += dot(c, c);
    h2 += dot(h, h);
    for (unsigned int i = 0; i < 3; ++i) {
      const Real t =
          factor * (map.cofactor[0][i] * s[0] + map.cofactor[1][i] * s[1] + map.cofactor[2][i] * s[2]);
      forces.m[3 + m][i] += t;
      for (unsigned int k = 0; k < 3; ++k)
        mean_forces[k][i] -= t * c[k];
    }
  }
  return total * moduli.bound(metric, eigenvalue, hourglass.ratio) *
         (1._r + c2 + square_root(h2) * (2._r + c2)) * load(constants + one_point::hourglass_bound * n_lanes);
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
                                           const std::size_t batch, Totals &totals, Result &result) {
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
  const HourglassModuli moduli(material);
  HourglassTrial hourglass;
  compute_hourglass(material, moduli, motion, mean, constants, history, hourglass);
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
  const Real hourglass_bound =
      add_hourglass(material, moduli, hourglass, map, metric, eigenvalue, constants, forces, mean_forces);
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
  totals.add(n, bound_rate(modulus * omega + hourglass_bound, damping.rate * J * omega), energies);
  const Mask bad = watch.failed | !(map.det > 0._r && map.det < finite_bound);
  if (__builtin_expect(any(bad), 0))
    note_failure(bad, first, result);
}

template <class Law, bool is_plastic>
void advance_one_point(const Elements &elements, const Material &material, const LaneFunctions &functions,
                       const Step &step, Result &result) {
  const std::size_t n_batches = (elements.n_elements + n_lanes - 1) / n_lanes;
  Totals totals;
  result.inverted = elements.n_elements;
  for (std::size_t batch = 0; batch < n_batches; ++batch) {
    prefetch(elements, step, batch + 2, n_batches, is_rate_form<Law>);
    advance_one_point_batch<Law, is_plastic>(elements, material, functions, step, batch, totals, result);
  }
  totals.finish(result);
}

} // namespace
} // namespace billet::explicit_kernels

#endif
