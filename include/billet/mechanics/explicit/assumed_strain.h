// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_ASSUMED_STRAIN_H
#define BILLET_MECHANICS_EXPLICIT_ASSUMED_STRAIN_H

#include "billet/mechanics/dual_number.h"
#include "billet/mechanics/explicit/mean_gradient.h"
#include "billet/mechanics/strain_modes.h"

// Eight points with assumed strains, (B1) to (B7) of doc/theory.md: j_q = Y_q J̄ replaces ∂x/∂ξ.
// The law receives j_q up to a factor, and det J̄.

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

/// Computes the share of the fourth mode, (B5).
inline Number compute_fourth(const Material &material) {
  const Number K = material.bulk, G = material.shear;
  const Number nu = (3._r * K - 2._r * G) / (6._r * K + 2._r * G);
  constexpr Number theta = static_cast<Number>(strain_modes::kept_shear);
  return square_root(2._r * (1._r + nu) / (3._r * (1._r + 2._r / 3._r * theta * theta)));
}

/// Computes the modes minus the contribution of the mean gradient: b̂_1, b̂_2, b̂_3, ĉ.
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

/// Frame of a brick and its strains by (B7), from the modes.
template <class T> struct Brick {
  strain_modes::Frame<T> frame;
  T hourglass[4][3];
  strain_modes::Products<T> products;
  strain_modes::Strains<T> strains;
};

/// Completes a brick whose frame's columns and hourglass vectors are set.
template <class T, class Invert, class Root>
BILLET_INLINE void complete(const StrainConstants &constants, const Invert &invert, const Root &root,
                            Brick<T> &brick) {
  strain_modes::complete(brick.frame, invert, root);
  strain_modes::multiply(brick.frame, brick.hourglass, brick.products);
  strain_modes::compute_strains<Number>(constants, brick.frame, brick.products, brick.strains);
}

BILLET_INLINE void complete(const StrainConstants &constants, Brick<Real> &brick) {
  complete(
      constants, [](const Real x) { return 1._r / x; }, [](const Real x) { return square_root(x); }, brick);
}

/// Changes in a step, without cancellation error.
struct BrickChange {
  Real columns[3][3], duals[3][3]; ///< changes of columns and duals
  Real beginning[3][3];            ///< duals at the beginning of the step
  strain_modes::Strains<Real> strains;
  Real determinant; ///< change of the determinant, in float only
  Mask inadmissible = {};
};

/// Copies the values of all numbers of an array.
BILLET_INLINE void get_values(const Stepped<Real> &step, Real &value) { value = step.value; }
template <class Step, class T, std::size_t n>
BILLET_INLINE void get_values(const Step (&step)[n], T (&value)[n]) {
  for (std::size_t k = 0; k < n; ++k)
    get_values(step[k], value[k]);
}

/// Completes `now` and `change` from the columns and hourglass vectors of `now` and their changes.
BILLET_INLINE void complete(const StrainConstants &constants, const Real delta[4][3], Brick<Real> &now,
                            BrickChange &change) {
  if constexpr (is_single) {
    // A difference of rounded numbers would lose its digits.
    using Both = Stepped<Real>;
    Brick<Both> both;
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        both.frame.columns[k][i] = {now.frame.columns[k][i], change.columns[k][i]};
    for (unsigned int m = 0; m < 4; ++m)
      for (unsigned int i = 0; i < 3; ++i)
        both.hourglass[m][i] = {now.hourglass[m][i], delta[m][i]};
    complete(
        constants, [](const Both &x) { return invert(x); },
        [](const Both &x) { return billet::square_root(x, [](const Real y) { return square_root(y); }); },
        both);
    get_values(both.frame.duals, now.frame.duals);
    get_values(both.frame.determinant, now.frame.determinant);
    get_values(both.frame.metric, now.frame.metric);
    get_values(both.frame.inverse_metric, now.frame.inverse_metric);
    get_values(both.frame.inverse_squares, now.frame.inverse_squares);
    get_values(both.frame.inverse_lengths, now.frame.inverse_lengths);
    get_values(both.frame.square_heights, now.frame.square_heights);
    get_values(both.frame.heights, now.frame.heights);
    get_values(both.frame.inverse_areas, now.frame.inverse_areas);
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int j = 0; j < 3; ++j)
        if (j != k)
          get_values(both.frame.slopes[k][j], now.frame.slopes[k][j]);
    get_values(both.products.of, now.products.of);
    get_values(both.strains.linear, now.strains.linear);
    get_values(both.strains.bilinear, now.strains.bilinear);
    for (unsigned int k = 0; k < 3; ++k) {
      for (unsigned int r = 0; r < 6; ++r) {
        change.strains.linear[k][r] = both.strains.linear[k][r].change;
        change.strains.bilinear[k][r] = both.strains.bilinear[k][r].change;
      }
      for (unsigned int i = 0; i < 3; ++i) {
        change.duals[k][i] = both.frame.duals[k][i].change;
        change.beginning[k][i] = both.frame.duals[k][i].before();
      }
    }
    change.determinant = both.frame.determinant.change;
    change.inadmissible = !(both.frame.determinant.before() > 0._r);
  } else {
    complete(constants, now);
    Brick<Real> before;
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        before.frame.columns[k][i] = now.frame.columns[k][i] - change.columns[k][i];
    for (unsigned int m = 0; m < 4; ++m)
      for (unsigned int i = 0; i < 3; ++i)
        before.hourglass[m][i] = now.hourglass[m][i] - delta[m][i];
    complete(constants, before);
    for (unsigned int k = 0; k < 3; ++k) {
      for (unsigned int r = 0; r < 6; ++r) {
        change.strains.linear[k][r] = now.strains.linear[k][r] - before.strains.linear[k][r];
        change.strains.bilinear[k][r] = now.strains.bilinear[k][r] - before.strains.bilinear[k][r];
      }
      for (unsigned int i = 0; i < 3; ++i) {
        change.duals[k][i] = now.frame.duals[k][i] - before.frame.duals[k][i];
        change.beginning[k][i] = before.frame.duals[k][i];
      }
    }
    change.inadmissible = !(before.frame.determinant > 0._r);
  }
}

/// Strains at the points, a_a·(Y − 1) a_b.
struct PointStrains {
  Real h[8][6];
};

constexpr unsigned int place_of_linear[3] = {1, 2, 4}, place_of_bilinear[3] = {6, 5, 3};

BILLET_INLINE void spread(const strain_modes::Strains<Real> &strains, PointStrains &points) {
  for (unsigned int r = 0; r < 6; ++r) {
    // values[0] and values[7] are zero
    Real l[3], b[3];
    for (unsigned int k = 0; k < 3; ++k) {
      l[k] = gauss * strains.linear[k][r];
      b[k] = (gauss * gauss) * strains.bilinear[k][r];
    }
    // Along ξ, for the modes 1 and η, ζ, ηζ; then along the two others.
    for (unsigned int x = 0; x < 2; ++x) {
      const Real mean = x == 0 ? -l[0] : l[0];
      const Real eta = x == 0 ? l[1] - b[2] : l[1] + b[2], zeta = x == 0 ? l[2] - b[1] : l[2] + b[1];
      const Real low = mean - eta, high = mean + eta, slope_low = zeta - b[0], slope_high = zeta + b[0];
      points.h[x][r] = low - slope_low;
      points.h[x + 2][r] = high - slope_high;
      points.h[x + 4][r] = low + slope_low;
      points.h[x + 6][r] = high + slope_high;
    }
  }
}

/// Sums and maxima over the points of an element.
struct AssumedSums {
  Watch watch;
  Real lambda[8];                          ///< λ_max of j⁻¹ j⁻ᵀ of the points
  Mask inadmissible = {};                  ///< a point's j is inverted or not finite
  Real distortion = {}, plastic_work = {}; ///< energies per volume, summed
};

/// Adds Σ_a v_a h_ab to result[b] for all b.
BILLET_INLINE void add_stretched(const Real v[3][3], const Real h[6], Real result[3][3]) {
  for (unsigned int b = 0; b < 3; ++b)
    for (unsigned int i = 0; i < 3; ++i)
      result[b][i] += v[0][i] * h[symmetric_index[0][b]] + v[1][i] * h[symmetric_index[1][b]] +
                      v[2][i] * h[symmetric_index[2][b]];
}

/// Computes the columns of j = Y J̄ at a point.
BILLET_INLINE void compute_columns(const strain_modes::Frame<Real> &frame, const Real h[6], Map &map) {
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      map.j[k][i] = frame.columns[k][i];
  add_stretched(frame.duals, h, map.j);
  map.complete();
}

/// Updates a point: `dev_tau` becomes its dev τ, `map` its j.
template <class Law, bool is_plastic>
BILLET_INLINE void update_assumed_point(const Material &material, const LaneFunctions &functions,
                                        const strain_modes::Frame<Real> &frame, const BrickChange &change,
                                        const Number *constants, const Real h[6], const Real h_change[6],
                                        Number *history, Map &map, Real dev_tau[6], AssumedSums &sums) {
  compute_columns(frame, h, map);
  if constexpr (is_rate_form<Law> || is_single) {
    Real d[3][3];
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        d[k][i] = change.columns[k][i];
    add_stretched(change.duals, h, d);
    add_stretched(change.beginning, h_change, d);
    Map other; // at mid-step, or before the step
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

/// Adds the contribution of a point to the sums. Sets `forces` = weight dev τ j⁻ᵀ, those of its
/// columns.
template <bool is_plastic>
BILLET_INLINE void add_assumed_point(const unsigned int q, const Real weight, const Real metric[6],
                                     const Real h[6], const Map &map, const Real dev_tau[6],
                                     AssumedSums &sums, Real forces[3][3]) {
  // Condition that Y is positive definite: minors of a_a·Y a_b, of which the largest is det j det
  // J̄.
  const Real c_11 = metric[0] + h[0], c_22 = metric[1] + h[1], c_12 = metric[3] + h[3];
  sums.inadmissible |=
      !(c_11 > 0._r && c_11 * c_22 > c_12 * c_12 && map.det > 0._r && map.det < finite_bound);
  const Real per_det = weight * map.inverse_det;
  Real scaled[6];
  for (unsigned int r = 0; r < 6; ++r)
    scaled[r] = per_det * dev_tau[r];
  for (unsigned int k = 0; k < 3; ++k)
    multiply(scaled, map.cofactor[k], forces[k]);
  sums.distortion += sums.watch.distortion;
  if constexpr (is_plastic)
    sums.plastic_work += sums.watch.plastic_work;
  Real bound[6];
  map.compute_metric(bound);
  sums.lambda[q] = bound_eigenvalue(bound) * (map.inverse_det * map.inverse_det);
}

/// Returns a bound of ⅛ Σ_q λ_q |∂v/∂ξ|²_q over the modes' squares, (X13), from the row sums of its
/// matrix.
BILLET_INLINE Real bound_points(const Real lambda[8]) {
  constexpr Number g = gauss, g2 = gauss * gauss, g3 = gauss * gauss * gauss;
  Real m[8]; // moments, indexed by the bits ξ, η, ζ
  for (unsigned int q = 0; q < 8; ++q)
    m[q] = lambda[q];
  hadamard(m);
  for (unsigned int q = 1; q < 8; ++q)
    m[q] = abs(m[q]);
  Real maximum = (1._r / 3._r) * m[0] + g2 * (m[3] + m[5] + m[6]) + (2._r * g3) * (m[1] + m[2] + m[4]);
  for (unsigned int k = 0; k < 3; ++k) {
    const unsigned int own = 1U << k, first = 1U << (k + 1) % 3, second = 1U << (k + 2) % 3;
    const Real slopes = g * (m[first] + m[second]);
    const Real of_column = m[0] + slopes + g2 * m[first | second],
               of_mode = (2._r / 3._r) * m[0] + slopes + g2 * (m[own | first] + m[own | second]) +
                         (2._r * g3) * m[own];
    maximum = max(maximum, max(of_column, of_mode));
  }
  return 0.125_r * maximum;
}

/// Sums over the points of the forces of their columns: mean, and per mode of the strains.
struct ColumnForces {
  Real mean[3][3], linear[3][3][3], bilinear[3][3][3];
};

BILLET_INLINE void sum_points(const Real points[8][3][3], ColumnForces &sums) {
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i) {
      Real values[8];
      for (unsigned int q = 0; q < 8; ++q)
        values[q] = points[q][k][i];
      hadamard(values);
      sums.mean[k][i] = values[0];
      for (unsigned int m = 0; m < 3; ++m) {
        sums.linear[m][k][i] = gauss * values[place_of_linear[m]];
        sums.bilinear[m][k][i] = (gauss * gauss) * values[place_of_bilinear[m]];
      }
    }
}

/// Computes the forces of one strain mode of j = a_b + Σ_a a^a h_ab. `stress`, work-conjugate to
/// h_ab, follows from the forces f_b of the columns; their effect on the duals, a^k·(Σ_b h_ab f_b),
/// is added at [a][k].
BILLET_INLINE void add_strain_forces(const Real duals[3][3], const Real f[3][3], const Real h[6],
                                     Real stress[6], Real of_duals[3][3]) {
  Real t[3][3]; // a^k·f_b
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int b = 0; b < 3; ++b)
      t[k][b] = dot(duals[k], f[b]);
  for (unsigned int r = 0; r < 6; ++r)
    stress[r] = r < 3 ? t[r][r] : t[row_of[r]][column_of[r]] + t[column_of[r]][row_of[r]];
  for (unsigned int a = 0; a < 3; ++a)
    for (unsigned int k = 0; k < 3; ++k)
      of_duals[a][k] += h[symmetric_index[a][0]] * t[k][0] + h[symmetric_index[a][1]] * t[k][1] +
                        h[symmetric_index[a][2]] * t[k][2];
}

/// Computes the forces of the modes from those of the points' columns.
BILLET_INLINE void compute_forces(const StrainConstants &strain_constants, const Brick<Real> &brick,
                                  const Real points[8][3][3], const Real pressure, const Number *constants,
                                  Modes &modal) {
  const strain_modes::Frame<Real> &frame = brick.frame;
  ColumnForces sums;
  sum_points(points, sums);
  strain_modes::Strains<Real> stresses;
  Real of_duals[3][3] = {};
  for (unsigned int m = 0; m < 3; ++m) {
    add_strain_forces(frame.duals, sums.linear[m], brick.strains.linear[m], stresses.linear[m], of_duals);
    add_strain_forces(frame.duals, sums.bilinear[m], brick.strains.bilinear[m], stresses.bilinear[m],
                      of_duals);
  }
  strain_modes::Forces<Real> forces;
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i) // δa^a = −Σ_k (a^a·δa_k) a^k
      forces.columns[k][i] = sums.mean[k][i] + pressure * frame.duals[k][i] -
                             (of_duals[0][k] * frame.duals[0][i] + of_duals[1][k] * frame.duals[1][i] +
                              of_duals[2][k] * frame.duals[2][i]);
  strain_modes::compute_forces<Number>(strain_constants, frame, brick.hourglass, brick.products, stresses,
                                       forces);
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int k = 0; k < 3; ++k) {
      const Real own = load(constants + (assumed_strain::own + 3 * m + k) * n_lanes);
      for (unsigned int i = 0; i < 3; ++i)
        forces.columns[k][i] -= own * forces.hourglass[m][i];
    }
  for (unsigned int i = 0; i < 3; ++i) {
    for (unsigned int m = 0; m < 6; ++m) {
      const Number *beta = constants + (mean_gradient::beta + 3 * m) * n_lanes;
      modal.m[m][i] = forces.columns[0][i] * load(beta) + forces.columns[1][i] * load(beta + n_lanes) +
                      forces.columns[2][i] * load(beta + 2 * n_lanes);
      if (m >= 3)
        modal.m[m][i] += forces.hourglass[m < 3 ? 0 : m - 3][i];
    }
    modal.m[6][i] = forces.hourglass[3][i];
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
  StrainConstants strain_constants;
  load_constants(constants, fourth, strain_constants);
  Brick<Real> brick;
  const strain_modes::Frame<Real> &frame = brick.frame;
  BrickChange change;
  compute_mean(motion.x, constants, brick.frame.columns);
  compute_hourglass(motion.x, frame.columns, constants, brick.hourglass);
  PointStrains now, of_step;
  if constexpr (with_step) {
    compute_mean(motion.delta, constants, change.columns);
    Real delta[4][3];
    compute_hourglass(motion.delta, change.columns, constants, delta);
    complete(strain_constants, delta, brick, change);
    spread(change.strains, of_step);
  } else
    complete(strain_constants, brick);
  spread(brick.strains, now);

  const Real reference_volume = load(constants + mean_gradient::volume * n_lanes);
  const Real inverse_det = load(constants + mean_gradient::inverse_det * n_lanes);
  const Real J = frame.determinant * inverse_det; // inaccurate for small changes
  AssumedSums sums;
  VolumeChange volume;
  if constexpr (is_single)
    volume = add_volume((reference_volume * inverse_det) * change.determinant, reference_volume, history);
  else
    volume = compare_volume(reference_volume * J, J, history);

  const Real weight = 0.125_r * reference_volume;
  Real points[8][3][3];
  for (unsigned int q = 0; q < 8; ++q) {
    Map map;
    Real dev_tau[6];
    update_assumed_point<Law, is_plastic>(
        material, functions, frame, change, constants, now.h[q], of_step.h[q],
        history + (last::n + q * layout.n_point_history) * n_lanes, map, dev_tau, sums);
    add_assumed_point<is_plastic>(q, weight, frame.metric, now.h[q], map, dev_tau, sums, points[q]);
  }

  const Real per_mass = reference_volume * load(constants + mean_gradient::bound * n_lanes);
  const Real omega = per_mass * bound_points(sums.lambda);
  // The sum is tr J̄⁻¹ J̄⁻ᵀ.
  const Real of_volume =
      per_mass * (frame.inverse_metric[0] + frame.inverse_metric[1] + frame.inverse_metric[2]);
  const Real mean_tau = material.bulk * volume.logarithm_of_J;
  const Damping damping = compute_viscosity(material, volume, history, static_cast<Number>(step.inverse_dt));
  store(history + last::omega * n_lanes, omega);
  Modes modal;
  compute_forces(strain_constants, brick, points, reference_volume * (mean_tau + J * damping.pressure),
                 constants, modal);
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
  totals.add(n, bound_rate(rate_squared, (1._r / 3._r) * damping.rate * J * of_volume), energies);
  Mask bad =
      sums.inadmissible | sums.watch.failed | !(frame.determinant > 0._r && frame.determinant < finite_bound);
  if constexpr (with_step)
    bad |= change.inadmissible;
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
