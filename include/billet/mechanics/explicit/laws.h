// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_LAWS_H
#define BILLET_MECHANICS_EXPLICIT_LAWS_H

#include "billet/mechanics/explicit/lanes.h"

// The laws at a point. `hourglass` is what a one-point element's stabilisation adds to the square of the
// stress in the yield condition, 6 G W (M32); zero for eight points. Symmetric tensors are 11, 22, 33, 12,
// 13, 23. Matrices are arrays of columns: m[k][i] is row i of column k.

namespace billet::explicit_kernels {
namespace {

constexpr unsigned int symmetric_index[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
constexpr unsigned int row_of[6] = {0, 1, 2, 0, 0, 1}, column_of[6] = {0, 1, 2, 1, 2, 2};

BILLET_INLINE void cross(const Real a[3], const Real b[3], Real c[3]) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}
BILLET_INLINE Real dot(const Real a[3], const Real b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// A : B of symmetric tensors.
BILLET_INLINE Real contract(const Real a[6], const Real b[6]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2. * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

BILLET_INLINE Real determinant(const Real a[6]) {
  return a[0] * (a[1] * a[2] - a[5] * a[5]) - a[3] * (a[3] * a[2] - a[5] * a[4]) +
         a[4] * (a[3] * a[5] - a[1] * a[4]);
}

/// A², A symmetric.
BILLET_INLINE void square(const Real a[6], Real result[6]) {
  result[0] = a[0] * a[0] + a[3] * a[3] + a[4] * a[4];
  result[1] = a[3] * a[3] + a[1] * a[1] + a[5] * a[5];
  result[2] = a[4] * a[4] + a[5] * a[5] + a[2] * a[2];
  result[3] = a[3] * (a[0] + a[1]) + a[4] * a[5];
  result[4] = a[4] * (a[0] + a[2]) + a[3] * a[5];
  result[5] = a[5] * (a[1] + a[2]) + a[3] * a[4];
}

/// S v.
BILLET_INLINE void multiply(const Real s[6], const Real v[3], Real result[3]) {
  for (unsigned int i = 0; i < 3; ++i)
    result[i] =
        s[symmetric_index[i][0]] * v[0] + s[symmetric_index[i][1]] * v[1] + s[symmetric_index[i][2]] * v[2];
}

/// M S Mᵀ, where columns m[k] are those of M.
BILLET_INLINE void push(const Real m[3][3], const Real s[6], Real result[6]) {
  Real ms[3][3]; // M S
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      ms[k][i] = m[0][i] * s[symmetric_index[0][k]] + m[1][i] * s[symmetric_index[1][k]] +
                 m[2][i] * s[symmetric_index[2][k]];
  for (unsigned int r = 0; r < 6; ++r)
    result[r] = ms[0][row_of[r]] * m[0][column_of[r]] + ms[1][row_of[r]] * m[1][column_of[r]] +
                ms[2][row_of[r]] * m[2][column_of[r]];
}

/// Mᵀ S M.
BILLET_INLINE void pull(const Real m[3][3], const Real s[6], Real result[6]) {
  Real sm[3][3]; // S M
  for (unsigned int k = 0; k < 3; ++k)
    multiply(s, m[k], sm[k]);
  for (unsigned int r = 0; r < 6; ++r)
    result[r] = dot(m[row_of[r]], sm[column_of[r]]);
}

/// The map from the element's own coordinates to space at a point, and its cofactors det j j⁻ᵀ.
struct Map {
  Real j[3][3], cofactor[3][3];
  Real det, inverse_det;

  BILLET_INLINE void complete() {
    cross(j[1], j[2], cofactor[0]);
    cross(j[2], j[0], cofactor[1]);
    cross(j[0], j[1], cofactor[2]);
    det = dot(j[0], cofactor[0]);
    inverse_det = 1. / det;
  }

  /// cofᵀ cof = det² j⁻¹ j⁻ᵀ.
  BILLET_INLINE void compute_metric(Real metric[6]) const {
    for (unsigned int r = 0; r < 6; ++r)
      metric[r] = dot(cofactor[row_of[r]], cofactor[column_of[r]]);
  }
};

/// Largest eigenvalue of a symmetric matrix, from above: Gershgorin's circles.
BILLET_INLINE Real bound_eigenvalue(const Real a[6]) {
  const Real a3 = abs(a[3]), a4 = abs(a[4]), a5 = abs(a[5]);
  return max(max(a[0] + a3 + a4, a[1] + a3 + a5), a[2] + a4 + a5);
}

/// What a law leaves behind, besides stress and history. Energies are of the last point, per volume.
struct Watch {
  Real distortion = {};   ///< elastic energy, but for that of the volume
  Real plastic_work = {}; ///< of the step: mean yield stress times the change of α
  Real mises = {};        ///< largest stress in the yield condition (Kirchhoff) of the points
  Real share = {};        ///< β of the last point: what the return has left of its trial stress
  Mask failed = {};       ///< not admissible
};

/// Slope of a hardening law that the kernels know, where the yield stress at α is known too: no exponential.
BILLET_INLINE Real compute_slope(const Material &material, const Real alpha, const Real yield_stress) {
  if (material.hardening_kind == HardeningKind::voce)
    return material.saturation_rate *
               (material.saturation_stress + material.hardening_modulus * alpha - yield_stress) +
           material.hardening_modulus;
  return material.exponent * yield_stress / (material.prestrain + alpha);
}

BILLET_INLINE Real compute_yield_stress(const Material &material, const Real alpha) {
  if (material.hardening_kind == HardeningKind::voce)
    return material.saturation_stress + material.hardening_modulus * alpha -
           (material.saturation_stress - material.yield_stress) *
               exponential(-material.saturation_rate * alpha);
  return material.strength * exponential(material.exponent * logarithm(material.prestrain + alpha));
}

/// Δα > 0 of the lanes that yield, q − m Δα = σ_y(α + Δα); `yield_stress` becomes the new one. With a concave
/// σ_y Newton's method approaches the root from one side.
BILLET_INLINE Real solve_consistency(const Material &material, const LaneFunctions &functions,
                                     const Mask yields, const Real q, const Real m, const Real alpha,
                                     Real &yield_stress) {
  Real delta{};
  if (material.hardening_kind == HardeningKind::other) {
    for (std::size_t lane = 0; lane < n_lanes; ++lane)
      if (get_mask(yields, lane)) {
        double value = 0.;
        set(delta, lane,
            functions.harden(material.hardening, get(q, lane), get(m, lane), get(alpha, lane), value));
        set(yield_stress, lane, value);
      }
    return delta;
  }
  Real excess = select(yields, q - yield_stress, Real{});
  for (unsigned int iteration = 0; iteration < 50 && any(excess > 4e-15 * q); ++iteration) {
    delta += excess / (m + compute_slope(material, alpha + delta, yield_stress));
    yield_stress = select(yields, compute_yield_stress(material, alpha + delta), yield_stress);
    excess = select(yields, q - m * delta - yield_stress, Real{});
  }
  return delta;
}

/// Where the yield condition is exceeded α grows; returns β = (q − m Δα)/q, or 1. `history` points at α (and
/// σ_y).
template <bool is_plastic>
BILLET_INLINE Real return_map(const Material &material, const LaneFunctions &functions, const Real q,
                              const Real m, double *history, Mask &yields, Watch &watch) {
  watch.plastic_work = Real{};
  if constexpr (!is_plastic)
    return broadcast(1.);
  const Real alpha = load(history);
  const bool is_linear = material.hardening_kind == HardeningKind::linear;
  Real yield =
      is_linear ? material.yield_stress + material.hardening_modulus * alpha : load(history + n_lanes);
  yields = q > yield;
  if (!any(yields))
    return broadcast(1.);
  Real delta{};
  if (is_linear) {
    delta = select(yields, (q - yield) / (m + material.hardening_modulus), delta);
    watch.plastic_work = delta * (yield + (0.5 * material.hardening_modulus) * delta);
  } else {
    const Real before = yield;
    delta = solve_consistency(material, functions, yields, q, m, alpha, yield);
    store(history + n_lanes, yield);
    watch.plastic_work = delta * (0.5 * (before + yield));
  }
  store(history, alpha + delta);
  return select(yields, 1. - m * delta / q, broadcast(1.));
}

/// Coefficients of a polynomial p(X) = p2 X² + p1 X + p0 of a traceless X; X³ = i2 X + i3.
struct Polynomial {
  Real p2 = {}, p1 = {}, p0 = {};

  /// p ← p X + c
  BILLET_INLINE void step(const Real i2, const Real i3, const double c) {
    const Real top = p2;
    p2 = p1;
    p1 = top * i2 + p0;
    p0 = top * i3 + c;
  }
};

/// ln(1 + X) by `n` terms of its series.
template <unsigned int n> BILLET_INLINE Polynomial logarithm_series(const Real i2, const Real i3) {
  Polynomial p;
  p.p0 = broadcast((n % 2 == 0 ? -1. : 1.) * series.reciprocal[n]);
  for (unsigned int k = n - 1; k >= 1; --k)
    p.step(i2, i3, (k % 2 == 0 ? -1. : 1.) * series.reciprocal[k]);
  p.step(i2, i3, 0.);
  return p;
}

/// exp(x) and exp(X) by n terms beyond 1: 1 + X/1 (1 + X/2 (1 + ...)).
template <unsigned int n> BILLET_INLINE Real exponential_series(const Real x) {
  Real sum = broadcast(1.);
  for (unsigned int k = n; k >= 1; --k)
    sum = 1. + sum * x * series.reciprocal[k];
  return sum;
}
template <unsigned int n> BILLET_INLINE Polynomial exponential_series(const Real i2, const Real i3) {
  Polynomial p;
  p.p0 = broadcast(series.inverse_factorial[n]);
  for (unsigned int k = n; k >= 1; --k)
    p.step(i2, i3, series.inverse_factorial[k - 1]);
  return p;
}

// Eigenvalues of a traceless X are at most √(4 i2/3). Up to 0.02, the small strains of metals, few terms do;
// up to 0.2 more; beyond that each lane is computed from its eigenvalues. Nine terms leave out 0.02⁹/10 of X,
// 24 0.2²⁴/25.
constexpr double small_i2 = 0.75 * 0.02 * 0.02, moderate_i2 = 0.75 * 0.2 * 0.2;

/// dev ln b and, in `mean`, tr ln(s b)/3, where X = s b − 1 with s = 3/tr b.
BILLET_INLINE void compute_logarithm(const LaneFunctions &functions, const Real x[6], const Real i2,
                                     Real logarithm[6], Real &mean, Mask &failed) {
  const Real i3 = determinant(x);
  const Polynomial p = __builtin_expect(any(!(i2 <= small_i2)), 0) ? logarithm_series<24>(i2, i3)
                                                                   : logarithm_series<9>(i2, i3);
  Real x2[6];
  square(x, x2);
  const Real shift = p.p2 * i2 * (2. / 3.); // tr X² = 2 i2
  mean = p.p0 + shift;
  for (unsigned int k = 0; k < 6; ++k)
    logarithm[k] = p.p2 * x2[k] + p.p1 * x[k] - (k < 3 ? shift : Real{});

  const Mask large = !(i2 <= moderate_i2);
  if (__builtin_expect(any(large), 0))
    for (std::size_t lane = 0; lane < n_lanes; ++lane)
      if (get_mask(large, lane)) {
        double sb[6], result[6], lane_mean = 0.;
        for (unsigned int k = 0; k < 6; ++k)
          sb[k] = get(x[k], lane) + (k < 3 ? 1. : 0.);
        if (!functions.logarithm(sb, result, lane_mean))
          set_mask(failed, lane);
        set(mean, lane, lane_mean);
        for (unsigned int k = 0; k < 6; ++k)
          set(logarithm[k], lane, result[k]);
      }
}

/// Hencky: history H with b_e = j H jᵀ up to a factor, which dev ln b_e does not see. dev τ = G dev ln b_e.
struct Hencky {
  static constexpr unsigned int n_tensor = 6;

  template <bool is_plastic>
  BILLET_INLINE static void update(const Material &material, const LaneFunctions &functions, const Map &map,
                                   const Real, const Real hourglass, double *history, Real dev_tau[6],
                                   Watch &watch) {
    Real h[6], x[6];
    for (unsigned int k = 0; k < 6; ++k)
      h[k] = load(history + k * n_lanes);
    push(map.j, h, x);
    const Real s = 3. / (x[0] + x[1] + x[2]);
    for (unsigned int k = 0; k < 6; ++k)
      x[k] = s * x[k] - (k < 3 ? 1. : 0.);
    const Real i2 = 0.5 * contract(x, x);
    Real log_b[6], mean;
    compute_logarithm(functions, x, i2, log_b, mean, watch.failed);

    const Real own = (1.5 * material.shear * material.shear) * contract(log_b, log_b);
    const Real q = square_root(own + hourglass);
    Mask yields{};
    const Real beta = return_map<is_plastic>(material, functions, q, broadcast(3. * material.shear),
                                             history + 6 * n_lanes, yields, watch);
    watch.mises = max(watch.mises, beta * q);
    watch.distortion = beta * beta * own * (1. / (6. * material.shear));
    watch.share = beta;
    const Real factor = beta * material.shear;
    for (unsigned int k = 0; k < 6; ++k)
      dev_tau[k] = factor * log_b[k];
    if (is_plastic && any(yields))
      flow(map, yields, s, beta, log_b, mean, history);
  }

  /// H = j⁻¹ b_e j⁻ᵀ after the return: s b_e = exp(mean) exp(β dev ln b_e).
  BILLET_INLINE static void flow(const Map &map, const Mask yields, const Real s, const Real beta,
                                 const Real log_b[6], const Real mean, double *history) {
    Real y[6], y2[6], b[6];
    for (unsigned int k = 0; k < 6; ++k)
      y[k] = beta * log_b[k];
    square(y, y2);
    const Real i2 = 0.5 * (y2[0] + y2[1] + y2[2]), i3 = determinant(y);
    const bool is_small = !any(!(i2 <= small_i2));
    const Polynomial p =
        __builtin_expect(is_small, 1) ? exponential_series<8>(i2, i3) : exponential_series<39>(i2, i3);
    const Real exp_mean =
        __builtin_expect(is_small, 1) ? exponential_series<5>(mean) : exponential_series<39>(mean);
    const Real scale = exp_mean / s * map.inverse_det * map.inverse_det;
    for (unsigned int k = 0; k < 6; ++k)
      b[k] = scale * (p.p2 * y2[k] + p.p1 * y[k] + (k < 3 ? p.p0 : Real{}));
    Real h[6];
    pull(map.cofactor, b, h);
    for (unsigned int k = 0; k < 6; ++k)
      store(history + k * n_lanes, select(yields, h[k], load(history + k * n_lanes)));
  }
};

/// Simo's neo-Hookean law: b̄_e = J^{-2/3} j H jᵀ, det b̄_e = 1, dev τ = G dev b̄_e.
struct NeoHookean {
  static constexpr unsigned int n_tensor = 6;

  template <bool is_plastic>
  BILLET_INLINE static void update(const Material &material, const LaneFunctions &functions, const Map &map,
                                   const Real J, const Real hourglass, double *history, Real dev_tau[6],
                                   Watch &watch) {
    Real h[6], b[6];
    for (unsigned int k = 0; k < 6; ++k)
      h[k] = load(history + k * n_lanes);
    push(map.j, h, b);
    const Real root = inverse_cube_root(J);
    const Real scale = root * root;
    const Real mean = (b[0] + b[1] + b[2]) * (1. / 3.);
    for (unsigned int k = 0; k < 6; ++k)
      dev_tau[k] = (material.shear * scale) * (b[k] - (k < 3 ? mean : Real{}));
    const Real own = 1.5 * contract(dev_tau, dev_tau);
    const Real q = square_root(own + hourglass);
    Mask yields{};
    const Real mean_bar = scale * mean; // tr b̄_e / 3
    const Real beta = return_map<is_plastic>(material, functions, q, (3. * material.shear) * mean_bar,
                                             history + 6 * n_lanes, yields, watch);
    // The bound of the tangent takes 2 G; what tr b̄_e/3 adds to it is put into the stress.
    watch.mises = max(watch.mises, beta * q + (material.shear * (2. / 3.)) * (mean_bar - 1.));
    watch.share = beta;
    if (is_plastic && any(yields)) {
      for (unsigned int k = 0; k < 6; ++k)
        dev_tau[k] *= beta;
      flow(material, map, yields, scale, mean_bar, beta, dev_tau, history, watch);
    } else {
      const double flexibility = 1. / material.shear;
      const Real i2 = (flexibility * flexibility / 3.) * own;
      const Real i3 = (flexibility * flexibility * flexibility) * determinant(dev_tau);
      watch.distortion = compute_distortion(material, mean_bar, i2, i3);
    }
  }

  /// ½ G (tr b̄_e − 3) with x = tr b̄_e / 3 and the invariants of dev b̄_e: x³ − 1 = i2 x − i3, without the
  /// difference of numbers next to 1.
  BILLET_INLINE static Real compute_distortion(const Material &material, const Real x, const Real i2,
                                               const Real i3) {
    return (1.5 * material.shear) * (i2 * x - i3) / (x * (x + 1.) + 1.);
  }

  /// b̄_e = dev τ/G + x 1 with the x that makes det b̄_e = 1: x³ − i2 x + i3 − 1 = 0. In H nothing but a
  /// multiple of j⁻¹ j⁻ᵀ is added.
  BILLET_INLINE static void flow(const Material &material, const Map &map, const Mask yields,
                                 const Real scale, const Real mean_bar, const Real beta,
                                 const Real dev_tau[6], double *history, Watch &watch) {
    const double flexibility = 1. / material.shear;
    const Real i2 = (0.5 * flexibility * flexibility) * contract(dev_tau, dev_tau);
    const Real i3 = (flexibility * flexibility * flexibility) * determinant(dev_tau);
    Real x = 1. + i2 * (1. / 3.) - i3 * (1. / 3.), correction;
    unsigned int iteration = 0;
    do {
      correction = (x * (x * x - i2) + i3 - 1.) / (3. * x * x - i2);
      x -= correction;
    } while (any(abs(correction) > 1e-9) && ++iteration < 20);
    watch.distortion = compute_distortion(material, x, i2, i3);
    const Real share = (x - beta * mean_bar) / scale * map.inverse_det * map.inverse_det;
    Real metric[6];
    map.compute_metric(metric);
    for (unsigned int k = 0; k < 6; ++k) {
      const Real h = load(history + k * n_lanes);
      store(history + k * n_lanes, select(yields, beta * h + share * metric[k], h));
    }
  }
};

/// The rate form: dev τ ← R dev τ Rᵀ + 2 G dev sym ΔL, ΔL = ∂Δu/∂x in the middle of the step, and
/// R = (1 − W/2)⁻¹ (1 + W/2), W = skew ΔL (Hughes & Winget 1980).
struct Hypoelastic {
  static constexpr unsigned int n_tensor = 5;

  template <bool is_plastic>
  BILLET_INLINE static void update(const Material &material, const LaneFunctions &functions,
                                   const Map &middle, const Real delta[3][3], const Real hourglass,
                                   double *history, Real dev_tau[6], Watch &watch) {
    Real l[3][3]; // l[k][i] = ΔL_ik = Σ_m Δ_im cof_km / det
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        l[k][i] =
            middle.inverse_det * (delta[0][i] * middle.cofactor[0][k] + delta[1][i] * middle.cofactor[1][k] +
                                  delta[2][i] * middle.cofactor[2][k]);
    rotate(l, history, dev_tau);
    const Real mean = (l[0][0] + l[1][1] + l[2][2]) * (1. / 3.);
    for (unsigned int k = 0; k < 3; ++k)
      dev_tau[k] += (2. * material.shear) * (l[k][k] - mean);
    for (unsigned int k = 3; k < 6; ++k)
      dev_tau[k] += material.shear * (l[column_of[k]][row_of[k]] + l[row_of[k]][column_of[k]]);

    const Real own = 1.5 * contract(dev_tau, dev_tau);
    const Real q = square_root(own + hourglass);
    Mask yields{};
    const Real beta = return_map<is_plastic>(material, functions, q, broadcast(3. * material.shear),
                                             history + 5 * n_lanes, yields, watch);
    watch.mises = max(watch.mises, beta * q);
    watch.distortion = beta * beta * own * (1. / (6. * material.shear));
    watch.share = beta;
    if (is_plastic)
      for (unsigned int k = 0; k < 6; ++k)
        dev_tau[k] *= beta;
    store(history, dev_tau[0]);
    store(history + n_lanes, dev_tau[1]);
    for (unsigned int k = 3; k < 6; ++k)
      store(history + (k - 1) * n_lanes, dev_tau[k]);
  }

  BILLET_INLINE static void rotate(const Real l[3][3], const double *history, Real dev_tau[6]) {
    Real s[6];
    s[0] = load(history);
    s[1] = load(history + n_lanes);
    s[2] = -s[0] - s[1];
    for (unsigned int k = 3; k < 6; ++k)
      s[k] = load(history + (k - 1) * n_lanes);
    // W is the cross product with w; R = 1 + (W + W²/2)/(1 + w²/4).
    const Real w[3] = {0.5 * (l[1][2] - l[2][1]), 0.5 * (l[2][0] - l[0][2]), 0.5 * (l[0][1] - l[1][0])};
    const Real w2 = dot(w, w);
    const Real a = 1. / (1. + 0.25 * w2);
    Real r[3][3];
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        r[k][i] = (0.5 * a) * (w[i] * w[k] - (i == k ? w2 : Real{})) + (i == k ? 1. : 0.);
    for (unsigned int k = 0; k < 3; ++k) {
      const unsigned int i = (k + 1) % 3, m = (k + 2) % 3;
      r[i][m] += a * w[k]; // W_mi = w_k, W_im = −w_k
      r[m][i] -= a * w[k];
    }
    push(r, s, dev_tau);
  }
};

template <class Law> constexpr bool is_rate_form = false;
template <> constexpr bool is_rate_form<Hypoelastic> = true;

} // namespace
} // namespace billet::explicit_kernels

#endif
