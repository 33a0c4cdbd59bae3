// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_ASSUMED_STRAIN_H
#define BILLET_MECHANICS_EXPLICIT_ASSUMED_STRAIN_H

#include "billet/mechanics/dual_number.h"
#include "billet/mechanics/explicit/mean_gradient.h"
#include "billet/mechanics/strain_modes.h"

// Eight points under assumed strains, (B1) to (B7) of doc/theory.md: j_q = Y_q J̄ in the place of ∂x/∂ξ. The
// law sees j_q up to a factor, and det J̄.

namespace billet::explicit_kernels {
namespace {

using StrainConstants = strain_modes::Constants<Real>;

BILLET_INLINE void load_constants(const Number *constants, const Number fourth, StrainConstants &result) {
  unsigned int place = 0;
  for (unsigned int j = 0; j < 3; ++j) {
    for (unsigned int k = 0; k < 3; ++k)
      if (j != k) {
        result.share[j][k] = load(constants + (assumed_strain::share + place) * n_lanes);
        result.shear[j][k] = load(constants + (assumed_strain::shear + place) * n_lanes);
        ++place;
      }
    result.thinning[j] = load(constants + (assumed_strain::thinning + j) * n_lanes);
  }
  result.fourth = broadcast(fourth);
}

/// Of the fourth mode, (B5).
inline Number compute_fourth(const Material &material) {
  const Number K = material.bulk, G = material.shear;
  const Number nu = (3._r * K - 2._r * G) / (6._r * K + 2._r * G);
  constexpr Number theta = static_cast<Number>(strain_modes::kept_shear);
  return square_root(2._r * (1._r + nu) / (3._r * (1._r + 2._r / 3._r * theta * theta)));
}

/// Modes less what the mean gradient makes of them: b̂_1, b̂_2, b̂_3, ĉ.
BILLET_INLINE void compute_hourglass(const Modes &modes, const Real columns[3][3], const Number *constants,
                                     Real hourglass[4][3]) {
  for (unsigned int m = 0; m < 4; ++m) {
    for (unsigned int i = 0; i < 3; ++i)
      hourglass[m][i] = modes.m[3 + m][i];
    for (unsigned int k = 0; k < 3; ++k) {
      const Real own = load(constants + (assumed_strain::own + 3 * m + k) * n_lanes);
      for (unsigned int i = 0; i < 3; ++i)
        hourglass[m][i] -= own * columns[k][i];
    }
  }
}

/// Y − 1 of the points.
struct PointStrains {
  Real y[8][6];
};

constexpr unsigned int place_of_linear[3] = {1, 2, 4}, place_of_bilinear[3] = {6, 5, 3};

BILLET_INLINE void spread(const strain_modes::Strains<Real> &strains, PointStrains &points) {
  for (unsigned int r = 0; r < 6; ++r) {
    Real values[8];
    values[0] = values[7] = Real{};
    for (unsigned int k = 0; k < 3; ++k) {
      values[place_of_linear[k]] = gauss * strains.linear[k][r];
      values[place_of_bilinear[k]] = (gauss * gauss) * strains.bilinear[k][r];
    }
    for (unsigned int bit = 1; bit < 8; bit *= 2)
      for (unsigned int q = 0; q < 8; ++q)
        if ((q & bit) == 0) {
          const Real mean = values[q], slope = values[q + bit];
          values[q] = mean - slope;
          values[q + bit] = mean + slope;
        }
    for (unsigned int q = 0; q < 8; ++q)
      points.y[q][r] = values[q];
  }
}

BILLET_INLINE Real reciprocal(const Real x) { return 1._r / x; }

BILLET_INLINE void complete_frame(const Real columns[3][3], strain_modes::Frame<Real> &frame) {
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      frame.columns[k][i] = columns[k][i];
  strain_modes::complete(
      frame, [](const Real x) { return reciprocal(x); }, [](const Real x) { return square_root(x); });
}

BILLET_INLINE void compute_point_strains(const StrainConstants &constants, const Real columns[3][3],
                                         const Real hourglass[4][3], PointStrains &points) {
  strain_modes::Frame<Real> frame;
  complete_frame(columns, frame);
  strain_modes::Strains<Real> strains;
  strain_modes::compute_strains<Number>(constants, frame, hourglass, strains);
  spread(strains, points);
}

/// Of a step: the strains in its middle and what they change by, as small as the step.
BILLET_INLINE void compute_strain_steps(const StrainConstants &constants, const MeanMotion &mean,
                                        const Real hourglass[4][3], const Real delta[4][3],
                                        const PointStrains &now, PointStrains &middle, PointStrains &change) {
  if constexpr (is_single) {
    // The difference of what is rounded would be lost.
    using Both = Stepped<Real>;
    strain_modes::Frame<Both> frame;
    Both vectors[4][3];
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i) {
        frame.columns[k][i] = mean.before.j[k][i];
        frame.columns[k][i].change = mean.d[k][i];
      }
    for (unsigned int m = 0; m < 4; ++m)
      for (unsigned int i = 0; i < 3; ++i) {
        vectors[m][i] = hourglass[m][i] - delta[m][i];
        vectors[m][i].change = delta[m][i];
      }
    strain_modes::complete(
        frame, [](const Both &x) { return invert(x); },
        [](const Both &x) { return billet::square_root(x, [](const Real y) { return square_root(y); }); });
    strain_modes::Strains<Both> strains;
    strain_modes::compute_strains<Number>(constants, frame, vectors, strains);
    strain_modes::Strains<Real> part;
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int r = 0; r < 6; ++r) {
        part.linear[k][r] = strains.linear[k][r].value + 0.5_r * strains.linear[k][r].change;
        part.bilinear[k][r] = strains.bilinear[k][r].value + 0.5_r * strains.bilinear[k][r].change;
      }
    spread(part, middle);
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int r = 0; r < 6; ++r) {
        part.linear[k][r] = strains.linear[k][r].change;
        part.bilinear[k][r] = strains.bilinear[k][r].change;
      }
    spread(part, change);
  } else {
    Real columns[3][3], vectors[4][3];
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        columns[k][i] = mean.now.j[k][i] - mean.d[k][i];
    for (unsigned int m = 0; m < 4; ++m)
      for (unsigned int i = 0; i < 3; ++i)
        vectors[m][i] = hourglass[m][i] - delta[m][i];
    PointStrains before;
    compute_point_strains(constants, columns, vectors, before);
    for (unsigned int q = 0; q < 8; ++q)
      for (unsigned int r = 0; r < 6; ++r) {
        change.y[q][r] = now.y[q][r] - before.y[q][r];
        middle.y[q][r] = 0.5_r * (now.y[q][r] + before.y[q][r]);
      }
  }
}

/// What the points of an element add up to.
struct AssumedSums {
  Watch watch;
  Real lambda[8];                          ///< λ_max of j⁻¹ j⁻ᵀ of the points
  Mask inadmissible = {};                  ///< a point's j inside out, or not finite
  Real distortion = {}, plastic_work = {}; ///< energies per volume, summed
  Real mean[3][3] = {};                    ///< Σ Y dev τ Y⁻¹, [row][column]
};

/// (1 + Y) v.
BILLET_INLINE void stretch(const Real y[6], const Real v[3], Real result[3]) {
  multiply(y, v, result);
  for (unsigned int i = 0; i < 3; ++i)
    result[i] += v[i];
}

/// `tau` becomes dev τ of a point, `map` its j.
template <class Law, bool is_plastic>
BILLET_INLINE void update_assumed_point(const Material &material, const LaneFunctions &functions,
                                        const MeanMotion &mean, const Number *constants, const Real y[6],
                                        const Real middle[6], const Real change[6], Number *history, Map &map,
                                        Real dev_tau[6], AssumedSums &sums) {
  for (unsigned int k = 0; k < 3; ++k)
    stretch(y, mean.now.j[k], map.j[k]);
  map.complete();
  if constexpr (is_rate_form<Law> || is_single) {
    Real d[3][3];
    for (unsigned int k = 0; k < 3; ++k) {
      Real column[3], of_change[3], of_mean[3];
      for (unsigned int i = 0; i < 3; ++i)
        column[i] = mean.now.j[k][i] - 0.5_r * mean.d[k][i];
      multiply(change, column, of_change);
      stretch(middle, mean.d[k], of_mean);
      for (unsigned int i = 0; i < 3; ++i)
        d[k][i] = of_change[i] + of_mean[i];
    }
    Map other; // in the middle of the step, or before it
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        other.j[k][i] = map.j[k][i] - (is_rate_form<Law> ? 0.5_r : 1._r) * d[k][i];
    other.complete();
    sums.inadmissible |= !(other.det > 0._r);
    if constexpr (is_rate_form<Law>)
      Law::template update<is_plastic>(material, functions, other, d, Real{}, history, dev_tau, sums.watch);
    else {
      Strain strain;
      strain.advance(other, d, history);
      Law::template update<is_plastic>(material, functions, strain, Real{}, history, dev_tau, sums.watch);
    }
  } else
    Law::template update<is_plastic>(material, functions, map,
                                     map.det * load(constants + mean_gradient::inverse_det * n_lanes), Real{},
                                     history, dev_tau, sums.watch);
}

/// Adds what dev τ of a point does: to the sums, and `stress` = sym(dev τ Y⁻¹).
template <bool is_plastic>
BILLET_INLINE void add_assumed_point(const unsigned int q, const Real h[6], const Map &map,
                                     const Real dev_tau[6], AssumedSums &sums, Real stress[6]) {
  Real y[6], cofactor[6];
  for (unsigned int r = 0; r < 6; ++r)
    y[r] = h[r] + (r < 3 ? 1._r : 0._r);
  cofactor[0] = y[1] * y[2] - y[5] * y[5];
  cofactor[1] = y[0] * y[2] - y[4] * y[4];
  cofactor[2] = y[0] * y[1] - y[3] * y[3];
  cofactor[3] = y[4] * y[5] - y[3] * y[2];
  cofactor[4] = y[3] * y[5] - y[1] * y[4];
  cofactor[5] = y[3] * y[4] - y[0] * y[5];
  const Real determinant = y[0] * cofactor[0] + y[3] * cofactor[3] + y[4] * cofactor[4];
  sums.inadmissible |=
      !(y[0] > 0._r && cofactor[2] > 0._r && determinant > 0._r && map.det > 0._r && map.det < finite_bound);
  const Real inverse = 1._r / determinant;
  Real product[3][3]; // dev τ Y⁻¹, its columns
  for (unsigned int k = 0; k < 3; ++k) {
    const Real column[3] = {inverse * cofactor[symmetric_index[0][k]],
                            inverse * cofactor[symmetric_index[1][k]],
                            inverse * cofactor[symmetric_index[2][k]]};
    multiply(dev_tau, column, product[k]);
    Real stretched[3];
    multiply(y, product[k], stretched);
    for (unsigned int i = 0; i < 3; ++i)
      sums.mean[i][k] += stretched[i];
  }
  for (unsigned int r = 0; r < 6; ++r)
    stress[r] = 0.5_r * (product[row_of[r]][column_of[r]] + product[column_of[r]][row_of[r]]);
  sums.distortion += sums.watch.distortion;
  if constexpr (is_plastic)
    sums.plastic_work += sums.watch.plastic_work;
  Real metric[6];
  map.compute_metric(metric);
  sums.lambda[q] = bound_eigenvalue(metric) * (map.inverse_det * map.inverse_det);
}

/// Bound of ⅛ Σ_q λ_q |∂v/∂ξ|²_q over the modes' squares, (B7), by the rows of its matrix.
BILLET_INLINE Real bound_points(const Real lambda[8]) {
  constexpr Number g = gauss, g2 = gauss * gauss, g3 = gauss * gauss * gauss;
  Real m[8]; // moments, by their bits ξ, η, ζ
  for (unsigned int q = 0; q < 8; ++q)
    m[q] = lambda[q];
  hadamard(m);
  for (unsigned int q = 1; q < 8; ++q)
    m[q] = abs(m[q]);
  Real largest = (1._r / 3._r) * m[0] + g2 * (m[3] + m[5] + m[6]) + (2._r * g3) * (m[1] + m[2] + m[4]);
  for (unsigned int k = 0; k < 3; ++k) {
    const unsigned int own = 1U << k, first = 1U << (k + 1) % 3, second = 1U << (k + 2) % 3;
    const Real slopes = g * (m[first] + m[second]);
    const Real of_column = m[0] + slopes + g2 * m[first | second],
               of_mode = (2._r / 3._r) * m[0] + slopes + g2 * (m[own | first] + m[own | second]) +
                         (2._r * g3) * m[own];
    largest = max(largest, max(of_column, of_mode));
  }
  return 0.125_r * largest;
}

/// Forces of the modes, from those of the strains and of the mean gradient.
BILLET_INLINE void compute_forces(const StrainConstants &strain_constants,
                                  const strain_modes::Frame<Real> &frame, const Real hourglass[4][3],
                                  const Real stress[8][6], const AssumedSums &sums, const Real weight,
                                  const Real pressure, const Number *constants, Modes &modal) {
  strain_modes::Strains<Real> stresses;
  for (unsigned int r = 0; r < 6; ++r) {
    Real values[8];
    for (unsigned int q = 0; q < 8; ++q)
      values[q] = stress[q][r];
    hadamard(values);
    for (unsigned int k = 0; k < 3; ++k) {
      stresses.linear[k][r] = (gauss * weight) * values[place_of_linear[k]];
      stresses.bilinear[k][r] = (gauss * gauss * weight) * values[place_of_bilinear[k]];
    }
  }
  strain_modes::Forces<Real> forces{};
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      forces.mean[i][j] = weight * sums.mean[i][j] + (i == j ? pressure : Real{});
  strain_modes::add_forces<Number>(strain_constants, frame, hourglass, stresses, forces);
  Real columns[3][3];
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      columns[k][i] = dot(forces.mean[i], frame.duals[k]);
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int k = 0; k < 3; ++k) {
      const Real own = load(constants + (assumed_strain::own + 3 * m + k) * n_lanes);
      for (unsigned int i = 0; i < 3; ++i)
        columns[k][i] -= own * forces.hourglass[m][i];
    }
  for (unsigned int m = 0; m < 7; ++m)
    for (unsigned int i = 0; i < 3; ++i) {
      Real sum = m < 3 ? Real{} : forces.hourglass[m < 3 ? 0 : m - 3][i];
      if (m < 6)
        for (unsigned int k = 0; k < 3; ++k)
          sum += columns[k][i] * load(constants + (mean_gradient::beta + 3 * m + k) * n_lanes);
      modal.m[m][i] = sum;
    }
}

template <class Law, bool is_plastic>
BILLET_INLINE void advance_assumed_strain_batch(const Elements &elements, const Material &material,
                                                const LaneFunctions &functions, const Step &step,
                                                const Number fourth, const std::size_t batch, Totals &totals,
                                                Result &result) {
  constexpr bool with_step = is_rate_form<Law> || is_single;
  const Layout &layout = elements.layout;
  const std::uint32_t *nodes = elements.nodes + batch * 8 * n_lanes;
  const Number *constants = elements.constants + batch * layout.n_constants * n_lanes;
  Number *history = elements.history + batch * layout.n_history * n_lanes;

  Motion motion;
  gather_motion<is_rate_form<Law>>(elements, step, nodes, constants + assumed_strain::modes * n_lanes,
                                   motion);
  MeanMotion mean;
  compute_mean_motion<is_rate_form<Law>>(motion, constants, mean);
  StrainConstants strain_constants;
  load_constants(constants, fourth, strain_constants);
  Real hourglass[4][3];
  compute_hourglass(motion.x, mean.now.j, constants, hourglass);
  strain_modes::Frame<Real> frame;
  complete_frame(mean.now.j, frame);
  strain_modes::Strains<Real> strains;
  strain_modes::compute_strains<Number>(strain_constants, frame, hourglass, strains);
  PointStrains now, middle, change;
  spread(strains, now);
  if constexpr (with_step) {
    Real delta[4][3];
    compute_hourglass(motion.delta, mean.d, constants, delta);
    compute_strain_steps(strain_constants, mean, hourglass, delta, now, middle, change);
  }

  const Real reference_volume = load(constants + mean_gradient::volume * n_lanes);
  AssumedSums sums;
  VolumeChange volume;
  if constexpr (is_single) {
    sums.inadmissible |= !(mean.before.det > 0._r);
    const Real scale = reference_volume * load(constants + mean_gradient::inverse_det * n_lanes);
    volume = add_volume(scale * compute_change(mean), reference_volume, history);
  } else
    volume = compare_volume(reference_volume * mean.J, mean.J, history);

  Real stress[8][6];
  for (unsigned int q = 0; q < 8; ++q) {
    Map map;
    Real dev_tau[6];
    update_assumed_point<Law, is_plastic>(
        material, functions, mean, constants, now.y[q], middle.y[q], change.y[q],
        history + (last::n + q * layout.n_point_history) * n_lanes, map, dev_tau, sums);
    add_assumed_point<is_plastic>(q, now.y[q], map, dev_tau, sums, stress[q]);
  }

  const Real per_mass = reference_volume * load(constants + mean_gradient::bound * n_lanes);
  const Real omega = per_mass * bound_points(sums.lambda);
  Real of_volume{}; // tr J̄⁻¹ J̄⁻ᵀ
  for (unsigned int k = 0; k < 3; ++k)
    of_volume += dot(frame.duals[k], frame.duals[k]);
  of_volume *= per_mass;
  const Real mean_tau = material.bulk * volume.logarithm_of_J;
  const Damping damping = compute_viscosity(material, volume, history, static_cast<Number>(step.inverse_dt));
  store(history + last::omega * n_lanes, omega);
  Modes modal;
  compute_forces(strain_constants, frame, hourglass, stress, sums, 0.125_r * reference_volume,
                 reference_volume * (mean_tau + mean.J * damping.pressure), constants, modal);
  const std::size_t first = batch * n_lanes;
  const std::size_t n = count_elements(elements, first);
  scatter_modes(modal, nodes, n, step);

  const Real elastic =
      min(max_modulus(material) * omega, material.bulk * of_volume + (2._r * material.shear) * omega);
  const Real rate_squared = elastic + (4._r * abs(mean_tau) + 3._r * sums.watch.mises) * omega;
  Energies energies;
  energies.elastic =
      reference_volume * (0.125_r * sums.distortion + compute_dilatation_energy(material, mean_tau));
  energies.plastic = 0.125_r * reference_volume * sums.plastic_work;
  energies.viscous = damping.work;
  totals.add(n, bound_rate(rate_squared, (1._r / 3._r) * damping.rate * mean.J * of_volume), energies);
  const Mask bad =
      sums.inadmissible | sums.watch.failed | !(mean.now.det > 0._r && mean.now.det < finite_bound);
  if (__builtin_expect(any(bad), 0))
    note_failure(bad, first, result);
}

template <class Law, bool is_plastic>
void advance_assumed_strain(const Elements &elements, const Material &material,
                            const LaneFunctions &functions, const Step &step, Result &result) {
  const std::size_t n_batches = (elements.n_elements + n_lanes - 1) / n_lanes;
  const Number fourth = compute_fourth(material);
  Totals totals;
  result.inverted = elements.n_elements;
  for (std::size_t batch = 0; batch < n_batches; ++batch) {
    prefetch(elements, step, batch + 2, n_batches, is_rate_form<Law>);
    advance_assumed_strain_batch<Law, is_plastic>(elements, material, functions, step, fourth, batch, totals,
                                                  result);
  }
  totals.finish(result);
}

} // namespace
} // namespace billet::explicit_kernels

#endif
