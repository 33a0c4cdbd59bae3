// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_LAWS_H
#define BILLET_MECHANICS_EXPLICIT_LAWS_H

#include "billet/mechanics/explicit/lanes.h"

// Material laws at a point. `hourglass` is the term 6 G W (X7) that the stabilisation of a
// one-point element adds to the squared stress in the yield condition. It is zero for eight points.
// Symmetric tensors have the order 11, 22, 33, 12, 13, 23. Matrices are arrays of columns: m[k][i]
// is row i of column k.

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

/// Returns A : B of symmetric tensors.
BILLET_INLINE Real contract(const Real a[6], const Real b[6]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2._r * (a[3] * b[3] + a[4] * b[4] + a[5] * b[5]);
}

BILLET_INLINE Real determinant(const Real a[6]) {
  return a[0] * (a[1] * a[2] - a[5] * a[5]) - a[3] * (a[3] * a[2] - a[5] * a[4]) +
         a[4] * (a[3] * a[5] - a[1] * a[4]);
}

/// Computes A² of a symmetric A.
BILLET_INLINE void square(const Real a[6], Real result[6]) {
  result[0] = a[0] * a[0] + a[3] * a[3] + a[4] * a[4];
  result[1] = a[3] * a[3] + a[1] * a[1] + a[5] * a[5];
  result[2] = a[4] * a[4] + a[5] * a[5] + a[2] * a[2];
  result[3] = a[3] * (a[0] + a[1]) + a[4] * a[5];
  result[4] = a[4] * (a[0] + a[2]) + a[3] * a[5];
  result[5] = a[5] * (a[1] + a[2]) + a[3] * a[4];
}

/// Computes S v.
BILLET_INLINE void multiply(const Real s[6], const Real v[3], Real result[3]) {
  for (unsigned int i = 0; i < 3; ++i)
    result[i] =
        s[symmetric_index[i][0]] * v[0] + s[symmetric_index[i][1]] * v[1] + s[symmetric_index[i][2]] * v[2];
}

/// Computes M S Mᵀ; m[k] are the columns of M.
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

/// Computes Mᵀ S M.
BILLET_INLINE void pull(const Real m[3][3], const Real s[6], Real result[6]) {
  Real sm[3][3]; // S M
  for (unsigned int k = 0; k < 3; ++k)
    multiply(s, m[k], sm[k]);
  for (unsigned int r = 0; r < 6; ++r)
    result[r] = dot(m[row_of[r]], sm[column_of[r]]);
}

/// Map from the element's own coordinates to space at a point, and its cofactors det j j⁻ᵀ.
struct Map {
  Real j[3][3], cofactor[3][3];
  Real det, inverse_det;

  BILLET_INLINE void complete() {
    cross(j[1], j[2], cofactor[0]);
    cross(j[2], j[0], cofactor[1]);
    cross(j[0], j[1], cofactor[2]);
    det = dot(j[0], cofactor[0]);
    inverse_det = 1._r / det;
  }

  /// Computes cofᵀ cof = det² j⁻¹ j⁻ᵀ.
  BILLET_INLINE void compute_metric(Real metric[6]) const {
    for (unsigned int r = 0; r < 6; ++r)
      metric[r] = dot(cofactor[row_of[r]], cofactor[column_of[r]]);
  }
};

/// Computes Σ_m d_m ∂ξ_m/∂x at a point, for vectors d that belong to the element's directions;
/// l[k][i] is L_ik.
BILLET_INLINE void compute_gradient(const Map &map, const Real d[3][3], Real l[3][3]) {
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      l[k][i] = map.inverse_det *
                (d[0][i] * map.cofactor[0][k] + d[1][i] * map.cofactor[1][k] + d[2][i] * map.cofactor[2][k]);
}

/// Computes M + Mᵀ + M Lᵀ. With M = L (1 + Y) this is the change of Y when 1 + Y becomes (1 +
/// L)(1 + Y)(1 + L)ᵀ, without cancellation error for small L.
BILLET_INLINE void compute_change(const Real l[3][3], const Real m[3][3], Real change[6]) {
  for (unsigned int r = 0; r < 6; ++r) {
    const unsigned int i = row_of[r], j = column_of[r];
    change[r] = m[j][i] + m[i][j] + (m[0][i] * l[0][j] + m[1][i] * l[1][j] + m[2][i] * l[2][j]);
  }
}

/// Computes L S.
BILLET_INLINE void multiply(const Real l[3][3], const Real s[6], Real m[3][3]) {
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      m[k][i] = l[0][i] * s[symmetric_index[0][k]] + l[1][i] * s[symmetric_index[1][k]] +
                l[2][i] * s[symmetric_index[2][k]];
}

/// Advances Y by a step with gradient L.
BILLET_INLINE void advance_strain(const Real l[3][3], Real y[6]) {
  Real m[3][3], change[6];
  multiply(l, y, m);
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      m[k][i] += l[k][i];
  compute_change(l, m, change);
  for (unsigned int k = 0; k < 6; ++k)
    y[k] += change[k];
}

/// Returns an upper bound of the eigenvalues of a symmetric matrix, by Gershgorin's circles.
BILLET_INLINE Real bound_eigenvalue(const Real a[6]) {
  const Real a3 = abs(a[3]), a4 = abs(a[4]), a5 = abs(a[5]);
  return max(max(a[0] + a3 + a4, a[1] + a3 + a5), a[2] + a4 + a5);
}

/// Results of a law other than stress and history. Energies are those of the last point, per
/// volume.
struct Watch {
  Real distortion = {};   ///< elastic energy without the volumetric part
  Real plastic_work = {}; ///< plastic work of the step: mean yield stress times the change of α
  Real mises = {};        ///< maximum stress in the yield condition (Kirchhoff) over the points
  Real share = {};        ///< β of the last point: factor of the return map on its trial stress
  Mask failed = {};       ///< inadmissible
};

/// Returns the slope of a hardening law that the kernels support. The yield stress at α is given,
/// which saves an exponential.
BILLET_INLINE Real compute_slope(const Hardening &hardening, const Real alpha, const Real yield_stress) {
  if (hardening.kind == HardeningKind::voce)
    return hardening.saturation_rate *
               (hardening.saturation_stress + hardening.modulus * alpha - yield_stress) +
           hardening.modulus;
  if (hardening.kind == HardeningKind::linear)
    return broadcast(hardening.modulus);
  return hardening.exponent * yield_stress / (hardening.prestrain + alpha);
}

BILLET_INLINE Real compute_yield_stress(const Hardening &hardening, const Real alpha) {
  if (hardening.kind == HardeningKind::voce)
    return hardening.saturation_stress + hardening.modulus * alpha -
           (hardening.saturation_stress - hardening.yield_stress) *
               exponential(-hardening.saturation_rate * alpha);
  if (hardening.kind == HardeningKind::linear)
    return hardening.yield_stress + hardening.modulus * alpha;
  return hardening.strength * exponential(hardening.exponent * logarithm(hardening.prestrain + alpha));
}

/// Tolerance relative to the yield stress.
constexpr Number consistency_tolerance = is_single ? 1e-6_r : 4e-15_r;

/// Solves q − m Δα = σ_y(α + Δα) for Δα > 0 in the lanes that yield; `yield_stress` becomes the new
/// one. With a concave σ_y Newton's method approaches the root from one side.
BILLET_INLINE Real solve_consistency(const Material &material, const LaneFunctions &functions,
                                     const Mask yields, const Real q, const Real m, const Real alpha,
                                     Real &yield_stress) {
  Real delta{};
  if (material.hardening.kind == HardeningKind::other) {
    for (std::size_t lane = 0; lane < n_lanes; ++lane)
      if (get_mask(yields, lane)) {
        double value = 0.;
        const double unit = material.stress_unit;
        set(delta, lane,
            static_cast<Number>(functions.harden(material.hardening.flow_stress, unit * get(q, lane),
                                                 unit * get(m, lane), get(alpha, lane), value)));
        set(yield_stress, lane, static_cast<Number>(value / unit));
      }
    return delta;
  }
  Real excess = select(yields, q - yield_stress, Real{});
  for (unsigned int iteration = 0; iteration < 50 && any(excess > consistency_tolerance * q); ++iteration) {
    delta += excess / (m + compute_slope(material.hardening, alpha + delta, yield_stress));
    yield_stress = select(yields, compute_yield_stress(material.hardening, alpha + delta), yield_stress);
    excess = select(yields, q - m * delta - yield_stress, Real{});
  }
  return delta;
}

/// Offsets of a point's plastic data. In float, α and the state of the flow stress are sums of two
/// parts. Increments may be below the last digit of the first part.
constexpr unsigned int n_parts = is_single ? 2 : 1, place_of_yield_stress = n_parts;

BILLET_INLINE std::size_t place_of_state(const Material &material) {
  return place_of_yield_stress + (material.hardening.kind == HardeningKind::linear ? 0 : 1);
}

/// Adds an increment to a number that is stored in parts.
BILLET_INLINE void accumulate(const Real delta, Number *history) {
  const Real before = load(history);
  if constexpr (!is_single) {
    store(history, before + delta);
    return;
  }
  const Real more = load(history + n_lanes) + delta;
  const Real sum = before + more;
  store(history, sum);
  store(history + n_lanes, more - (sum - before));
}

/// Plastic flow of a step.
struct Flow {
  Real strain;       ///< Δα ≥ 0
  Real yield_stress; ///< σ_y(α + Δα), at rest
  Real flow_stress;  ///< q − m Δα
  Real plastic_work; ///< of the step, per volume
};

/// Computes the flow in the lanes that yield, one after the other, and advances their state. Lanes
/// without time to flow no longer yield. `history` points at α, `before` is σ_y(α).
BILLET_INLINE Flow flow_by_lane(const Material &material, const LaneFunctions &functions, const Real q,
                                const Real m, const Real before, Number *history, Mask &yields) {
  Flow flow{Real{}, before, q, Real{}};
  Number *state = history + place_of_state(material) * n_lanes;
  for (std::size_t lane = 0; lane < n_lanes; ++lane)
    if (get_mask(yields, lane)) {
      double numbers[max_flow_state] = {};
      for (std::size_t k = 0; k < material.hardening.n_state; ++k)
        for (std::size_t part = 0; part < n_parts; ++part)
          numbers[k] += state[(k * n_parts + part) * n_lanes + lane];
      const double unit = material.stress_unit;
      const LaneFlow own = functions.flow(material.hardening.flow_stress, unit * get(q, lane),
                                          unit * get(m, lane), history[lane], material.rate.dt, numbers);
      set(flow.strain, lane, static_cast<Number>(own.strain));
      set(flow.yield_stress, lane, static_cast<Number>(own.yield_stress / unit));
      set(flow.flow_stress, lane, static_cast<Number>(own.flow_stress / unit));
      set(flow.plastic_work, lane, static_cast<Number>(own.plastic_work / unit));
      for (std::size_t k = 0; k < material.hardening.n_state; ++k)
        for (std::size_t part = 0; part < n_parts; ++part) {
          Number &stored = state[(k * n_parts + part) * n_lanes + lane];
          stored = static_cast<Number>(numbers[k]);
          numbers[k] -= stored;
        }
    }
  yields = flow.strain > Real{};
  return flow;
}

/// Computes σ_y(α) and its slope in the lanes that yield.
BILLET_INLINE void evaluate_hardening(const Material &material, const LaneFunctions &functions,
                                      const Mask yields, const Real alpha, Real &yield, Real &slope) {
  if (material.hardening.kind != HardeningKind::other) {
    yield = compute_yield_stress(material.hardening, alpha);
    slope = compute_slope(material.hardening, alpha, yield);
    return;
  }
  for (std::size_t lane = 0; lane < n_lanes; ++lane)
    if (get_mask(yields, lane)) {
      double own_slope = 0.;
      const double own = functions.yield_stress(material.hardening.flow_stress, get(alpha, lane), own_slope);
      set(yield, lane, static_cast<Number>(own / material.stress_unit));
      set(slope, lane, static_cast<Number>(own_slope / material.stress_unit));
    }
}

/// Returns x^p for positive x.
BILLET_INLINE Real power(const Real x, const Number p) { return exponential(p * logarithm(x)); }

/// Bound on the last change of Δα, relative to Δα: the rest is below consistency_tolerance.
constexpr Number root_tolerance = is_single ? 1e-3_r : 6e-8_r;

/// Computes the flow at a rate, q − m Δα = σ_y(α + Δα) (1 + x) with x = (Δα/DΔt)^{1/p}, in the
/// lanes that yield; `before` is σ_y(α). In x the slope at rest is finite. Each side alone bounds x
/// from above; Halley's method starts at the smaller bound, and bisects where it would leave the
/// bracket. Without time to flow no lane yields.
BILLET_INLINE Flow flow_at_rate(const Material &material, const LaneFunctions &functions, const Real all_q,
                                const Real m, const Real alpha, const Real before, Mask &yields) {
  const Number p = material.rate.exponent, unit = material.rate.reference_increment;
  if (!(unit > 0._r)) {
    yields = Mask{};
    return {Real{}, before, all_q, Real{}};
  }
  // Other lanes have any number.
  const Real q = select(yields, all_q, 2._r * before), excess = q - before;
  Real x = min(excess / before, power(excess / (unit * m), 1._r / p));
  Real low{}, high = x, step{}, delta{}, yield = before, slope{};
  for (unsigned int iteration = 0; iteration < 60; ++iteration) {
    delta = unit * power(x, p);
    evaluate_hardening(material, functions, yields, alpha + delta, yield, slope);
    const Real residual = q - m * delta - yield * (1._r + x);
    const Real stiffness = m + slope * (1._r + x), change = p * delta / x; // dΔα/dx
    const Real descent = stiffness * change + yield;                       // −d residual/dx
    // `bend` is its derivative, but for σ_y''.
    const Real bend = ((p - 1._r) * stiffness / x + 2._r * slope) * change;
    const Real newton = residual / descent;
    const Real halley = newton / (1._r + 0.5_r * newton * bend / descent);
    const Mask is_below = residual > Real{};
    low = select(is_below, x, low);
    high = select(is_below, high, x);
    const Real next = x + halley;
    step = select((next >= low) & (next <= high), halley, 0.5_r * (low + high) - x);
    x += step;
    const Mask moves = p * abs(step) > root_tolerance * x, is_off = abs(residual) > consistency_tolerance * q;
    if (!any(moves & is_off))
      break;
  }
  const Real part = step / (x - step);
  // Change of Δα by the last step.
  const Real last = p * part * (1._r + (0.5_r * (p - 1._r)) * part) * delta;
  delta = select(yields, delta + last, Real{});
  yield = select(yields, yield + slope * last, before);
  const Real factor = 1._r + x;
  return {delta, yield, factor * yield, (0.5_r * factor) * (before + yield) * delta};
}

/// Computes the flow of laws beyond the closed forms, and stores σ_y and the state behind α.
__attribute__((noinline)) Flow flow_with_state(const Material &material, const LaneFunctions &functions,
                                               const Real q, const Real m, const Real before, Number *history,
                                               Mask &yields) {
  Flow flow;
  if (material.rate.kind != RateKind::power_law)
    flow = flow_by_lane(material, functions, q, m, before, history, yields);
  else {
    flow = flow_at_rate(material, functions, q, m, load(history), before, yields);
    accumulate(static_cast<Number>(material.stress_unit) * flow.plastic_work,
               history + place_of_state(material) * n_lanes);
  }
  if (material.hardening.kind != HardeningKind::linear)
    store(history + place_of_yield_stress * n_lanes, flow.yield_stress);
  return flow;
}

/// Performs the return map: if the yield condition is exceeded, α increases. Returns β = (q − m
/// Δα)/q, or 1. `history` points at α, then as in kernel.h.
template <bool is_plastic>
BILLET_INLINE Real return_map(const Material &material, const LaneFunctions &functions, const Real q,
                              const Real m, Number *history, Mask &yields, Watch &watch) {
  watch.plastic_work = Real{};
  if constexpr (!is_plastic)
    return broadcast(1._r);
  const Real alpha = load(history);
  const bool is_linear = material.hardening.kind == HardeningKind::linear;
  Real yield = is_linear ? material.hardening.yield_stress + material.hardening.modulus * alpha
                         : load(history + place_of_yield_stress * n_lanes);
  yields = q > yield;
  if (!any(yields))
    return broadcast(1._r);
  Real delta{};
  if (material.rate.kind != RateKind::none) {
    const Flow flow = flow_with_state(material, functions, q, m, yield, history, yields);
    delta = flow.strain;
    watch.plastic_work = flow.plastic_work;
    yield = flow.flow_stress;
  } else if (is_linear) {
    delta = select(yields, (q - yield) / (m + material.hardening.modulus), delta);
    watch.plastic_work = delta * (yield + (0.5_r * material.hardening.modulus) * delta);
    if constexpr (is_single)
      yield += material.hardening.modulus * delta;
  } else {
    const Real before = yield;
    delta = solve_consistency(material, functions, yields, q, m, alpha, yield);
    store(history + place_of_yield_stress * n_lanes, yield);
    watch.plastic_work = delta * (0.5_r * (before + yield));
  }
  accumulate(delta, history);
  if constexpr (is_single) // the same, without cancellation
    return select(yields, yield / q, broadcast(1._r));
  return select(yields, 1._r - m * delta / q, broadcast(1._r));
}

/// Coefficients of a polynomial p(X) = p2 X² + p1 X + p0 of a traceless X; X³ = i2 X + i3.
struct Polynomial {
  Real p2 = {}, p1 = {}, p0 = {};

  /// Performs p ← p X + c.
  BILLET_INLINE void step(const Real i2, const Real i3, const Number c) {
    const Real top = p2;
    p2 = p1;
    p1 = top * i2 + p0;
    p0 = top * i3 + c;
  }
};

/// Returns ln(1 + X) by `n` terms of its series.
template <unsigned int n> BILLET_INLINE Polynomial logarithm_series(const Real i2, const Real i3) {
  Polynomial p;
  p.p0 = broadcast((n % 2 == 0 ? -1._r : 1._r) * series.reciprocal[n]);
  for (unsigned int k = n - 1; k >= 1; --k)
    p.step(i2, i3, (k % 2 == 0 ? -1._r : 1._r) * series.reciprocal[k]);
  p.step(i2, i3, 0._r);
  return p;
}

/// Return exp(x) and exp(X) by n terms beyond 1: 1 + X/1 (1 + X/2 (1 + ...)).
template <unsigned int n> BILLET_INLINE Real exponential_series(const Real x) {
  Real sum = broadcast(1._r);
  for (unsigned int k = n; k >= 1; --k)
    sum = 1._r + sum * x * series.reciprocal[k];
  return sum;
}
/// `first` is 1, or 0 for exp(X) − 1.
template <unsigned int n>
BILLET_INLINE Polynomial exponential_series(const Real i2, const Real i3, const Number first) {
  Polynomial p;
  p.p0 = broadcast(series.inverse_factorial[n]);
  for (unsigned int k = n; k >= 1; --k)
    p.step(i2, i3, k > 1 ? series.inverse_factorial[k - 1] : first);
  return p;
}

// Eigenvalues of a traceless X are at most √(4 i2/3). Up to `small_strain`, as in metals, few terms
// suffice; up to `moderate_strain` more are needed; beyond that each lane is computed from its
// eigenvalues. In double, the truncation error relative to X is 0.02⁹/10 with nine terms, and
// 0.2²⁴/25 with 24. In float it is 0.05⁶/7 = 2e-9 with six, and 0.35¹⁵/16 = 9e-9 with 15.
constexpr Number small_strain = is_single ? 0.05_r : 0.02_r, moderate_strain = is_single ? 0.35_r : 0.2_r;
constexpr Number small_i2 = 0.75_r * small_strain * small_strain,
                 moderate_i2 = 0.75_r * moderate_strain * moderate_strain;
constexpr unsigned int n_small_logarithm = is_single ? 6 : 9, n_moderate_logarithm = is_single ? 15 : 24,
                       n_small_exponential = is_single ? 5 : 8, n_large_exponential = is_single ? 24 : 39;

/// Computes dev ln b and, in `mean`, tr ln(s b)/3, where X = s b − 1 with s = 3/tr b.
BILLET_INLINE void compute_logarithm(const LaneFunctions &functions, const Real x[6], const Real i2,
                                     Real logarithm[6], Real &mean, Mask &failed) {
  const Real i3 = determinant(x);
  const Polynomial p = __builtin_expect(any(!(i2 <= small_i2)), 0)
                           ? logarithm_series<n_moderate_logarithm>(i2, i3)
                           : logarithm_series<n_small_logarithm>(i2, i3);
  Real x2[6];
  square(x, x2);
  const Real shift = p.p2 * i2 * (2._r / 3._r); // tr X² = 2 i2
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
        set(mean, lane, static_cast<Number>(lane_mean));
        for (unsigned int k = 0; k < 6; ++k)
          set(logarithm[k], lane, static_cast<Number>(result[k]));
      }
}

/// Elastic strain at a point, in the form of the history of float kernels: Y = b_e − 1 up to a
/// factor of b_e.
struct Strain {
  Real y[6];

  BILLET_INLINE void load_from(const Number *history) {
    for (unsigned int k = 0; k < 6; ++k)
      y[k] = load(history + k * n_lanes);
  }

  BILLET_INLINE void store_to(Number *history) const {
    for (unsigned int k = 0; k < 6; ++k)
      store(history + k * n_lanes, y[k]);
  }

  /// Advances the strain by a step of displacements d, which belong to the element's directions;
  /// `before` is the map at the start of the step.
  BILLET_INLINE void advance(const Map &before, const Real d[3][3], const Number *history) {
    Real l[3][3];
    compute_gradient(before, d, l);
    load_from(history);
    advance_strain(l, y);
  }

  BILLET_INLINE Real mean() const { return (y[0] + y[1] + y[2]) * (1._r / 3._r); }
};

/// Hencky's law: dev τ = G dev ln b_e, which does not depend on a factor of b_e.
struct Hencky {
  /// Computes the response for `x` = 3 b_e/tr b_e − 1. Returns the lanes that yield; β is in
  /// `watch`. `plastic` points at α.
  template <bool is_plastic>
  BILLET_INLINE static Mask respond(const Material &material, const LaneFunctions &functions, const Real x[6],
                                    const Real hourglass, Number *plastic, Real log_b[6], Real &mean,
                                    Real dev_tau[6], Watch &watch) {
    const Real i2 = 0.5_r * contract(x, x);
    compute_logarithm(functions, x, i2, log_b, mean, watch.failed);

    const Real own = (1.5_r * material.shear * material.shear) * contract(log_b, log_b);
    const Real q = square_root(own + hourglass);
    Mask yields{};
    const Real beta = return_map<is_plastic>(material, functions, q, broadcast(3._r * material.shear),
                                             plastic, yields, watch);
    watch.mises = max(watch.mises, beta * q);
    watch.distortion = beta * beta * own * (1._r / (6._r * material.shear));
    watch.share = beta;
    const Real factor = beta * material.shear;
    for (unsigned int k = 0; k < 6; ++k)
      dev_tau[k] = factor * log_b[k];
    return yields;
  }

  /// Updates the history H, with b_e = j H jᵀ.
  template <bool is_plastic>
  BILLET_INLINE static void update(const Material &material, const LaneFunctions &functions, const Map &map,
                                   const Real, const Real hourglass, Number *history, Real dev_tau[6],
                                   Watch &watch) {
    Real h[6], x[6];
    for (unsigned int k = 0; k < 6; ++k)
      h[k] = load(history + k * n_lanes);
    push(map.j, h, x);
    const Real s = 3._r / (x[0] + x[1] + x[2]);
    for (unsigned int k = 0; k < 6; ++k)
      x[k] = s * x[k] - (k < 3 ? 1._r : 0._r);
    Real log_b[6], mean;
    const Mask yields = respond<is_plastic>(material, functions, x, hourglass, history + 6 * n_lanes, log_b,
                                            mean, dev_tau, watch);
    if (is_plastic && any(yields))
      flow(map, yields, s, watch.share, log_b, mean, history);
  }

  /// Updates from the strain, and stores the strain in the history.
  template <bool is_plastic>
  BILLET_INLINE static void update(const Material &material, const LaneFunctions &functions, Strain &strain,
                                   const Real hourglass, Number *history, Real dev_tau[6], Watch &watch) {
    const Real third = strain.mean();
    const Real s = 1._r / (1._r + third);
    Real x[6], log_b[6], mean;
    for (unsigned int k = 0; k < 6; ++k)
      x[k] = s * (strain.y[k] - (k < 3 ? third : Real{}));
    const Mask yields = respond<is_plastic>(material, functions, x, hourglass, history + 6 * n_lanes, log_b,
                                            mean, dev_tau, watch);
    if (is_plastic && any(yields))
      flow(yields, watch.share, log_b, strain);
    strain.store_to(history);
  }

  /// Returns exp(Y) by few terms or many.
  BILLET_INLINE static Polynomial exponentiate(const Real i2, const Real i3, const Number first,
                                               const bool is_small) {
    return __builtin_expect(is_small, 1) ? exponential_series<n_small_exponential>(i2, i3, first)
                                         : exponential_series<n_large_exponential>(i2, i3, first);
  }

  /// Sets H = j⁻¹ b_e j⁻ᵀ after the return map: s b_e = exp(mean) exp(β dev ln b_e).
  BILLET_INLINE static void flow(const Map &map, const Mask yields, const Real s, const Real beta,
                                 const Real log_b[6], const Real mean, Number *history) {
    Real y[6], y2[6], b[6];
    for (unsigned int k = 0; k < 6; ++k)
      y[k] = beta * log_b[k];
    square(y, y2);
    const Real i2 = 0.5_r * (y2[0] + y2[1] + y2[2]), i3 = determinant(y);
    const bool is_small = !any(!(i2 <= small_i2));
    const Polynomial p = exponentiate(i2, i3, 1._r, is_small);
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

  /// Sets b_e = exp(β dev ln b_e) after the return map.
  BILLET_INLINE static void flow(const Mask yields, const Real beta, const Real log_b[6], Strain &strain) {
    Real y[6], y2[6];
    for (unsigned int k = 0; k < 6; ++k)
      y[k] = beta * log_b[k];
    square(y, y2);
    const Real i2 = 0.5_r * (y2[0] + y2[1] + y2[2]), i3 = determinant(y);
    const Polynomial p = exponentiate(i2, i3, 0._r, !any(!(i2 <= small_i2)));
    for (unsigned int k = 0; k < 6; ++k)
      strain.y[k] = select(yields, p.p2 * y2[k] + p.p1 * y[k] + (k < 3 ? p.p0 : Real{}), strain.y[k]);
  }
};

/// Simo's neo-Hookean law: dev τ = G dev b̄_e, det b̄_e = 1.
struct NeoHookean {
  /// Computes the response for `dev_tau` = G dev b̄_e of the trial state; the caller applies the
  /// factor β. Returns the lanes that yield; `own` becomes 3/2 dev τ : dev τ of the trial state.
  template <bool is_plastic>
  BILLET_INLINE static Mask respond(const Material &material, const LaneFunctions &functions,
                                    const Real dev_tau[6], const Real mean_bar, const Real hourglass,
                                    Number *plastic, Real &own, Watch &watch) {
    own = 1.5_r * contract(dev_tau, dev_tau);
    const Real q = square_root(own + hourglass);
    Mask yields{};
    const Real beta = return_map<is_plastic>(material, functions, q, (3._r * material.shear) * mean_bar,
                                             plastic, yields, watch);
    // The bound of the tangent uses 2 G; the extra term from tr b̄_e/3 is added to the stress.
    watch.mises = max(watch.mises, beta * q + (material.shear * (2._r / 3._r)) * (mean_bar - 1._r));
    watch.share = beta;
    return yields;
  }

  /// Stores the energy if no lane yields.
  BILLET_INLINE static void store_energy(const Material &material, const Real dev_tau[6], const Real mean_bar,
                                         const Real own, Watch &watch) {
    const Number flexibility = 1._r / material.shear;
    const Real i2 = (flexibility * flexibility / 3._r) * own;
    const Real i3 = (flexibility * flexibility * flexibility) * determinant(dev_tau);
    watch.distortion = compute_distortion(material, mean_bar, i2, i3);
  }

  /// Updates the history H, with b̄_e = J^{-2/3} j H jᵀ.
  template <bool is_plastic>
  BILLET_INLINE static void update(const Material &material, const LaneFunctions &functions, const Map &map,
                                   const Real J, const Real hourglass, Number *history, Real dev_tau[6],
                                   Watch &watch) {
    Real h[6], b[6];
    for (unsigned int k = 0; k < 6; ++k)
      h[k] = load(history + k * n_lanes);
    push(map.j, h, b);
    const Real root = inverse_cube_root(J);
    const Real scale = root * root;
    const Real mean = (b[0] + b[1] + b[2]) * (1._r / 3._r);
    for (unsigned int k = 0; k < 6; ++k)
      dev_tau[k] = (material.shear * scale) * (b[k] - (k < 3 ? mean : Real{}));
    const Real mean_bar = scale * mean; // tr b̄_e / 3
    Real own;
    const Mask yields = respond<is_plastic>(material, functions, dev_tau, mean_bar, hourglass,
                                            history + 6 * n_lanes, own, watch);
    if (is_plastic && any(yields)) {
      for (unsigned int k = 0; k < 6; ++k)
        dev_tau[k] *= watch.share;
      flow(material, map, yields, scale, mean_bar, watch.share, dev_tau, history, watch);
    } else
      store_energy(material, dev_tau, mean_bar, own, watch);
  }

  /// Updates from the strain, and stores the strain in the history.
  template <bool is_plastic>
  BILLET_INLINE static void update(const Material &material, const LaneFunctions &functions, Strain &strain,
                                   const Real hourglass, Number *history, Real dev_tau[6], Watch &watch) {
    // b̄_e = (1 + Y)/det(1 + Y)^{1/3}
    const Real *y = strain.y;
    const Real trace = y[0] + y[1] + y[2];
    const Real minors = y[0] * y[1] + y[1] * y[2] + y[2] * y[0] - (y[3] * y[3] + y[4] * y[4] + y[5] * y[5]);
    const Real det = 1._r + (trace + (minors + determinant(y)));
    watch.failed |= !(det > 0._r);
    const Real scale = inverse_cube_root(det), mean = trace * (1._r / 3._r);
    for (unsigned int k = 0; k < 6; ++k)
      dev_tau[k] = (material.shear * scale) * (y[k] - (k < 3 ? mean : Real{}));
    const Real mean_bar = scale * (1._r + mean);
    Real own;
    const Mask yields = respond<is_plastic>(material, functions, dev_tau, mean_bar, hourglass,
                                            history + 6 * n_lanes, own, watch);
    if (is_plastic && any(yields)) {
      for (unsigned int k = 0; k < 6; ++k)
        dev_tau[k] *= watch.share;
      flow(material, yields, dev_tau, strain, watch);
    } else
      store_energy(material, dev_tau, mean_bar, own, watch);
    strain.store_to(history);
  }

  /// Returns ½ G (tr b̄_e − 3) with x = tr b̄_e / 3 and the invariants of dev b̄_e:
  /// x³ − 1 = i2 x − i3. This avoids the difference of numbers close to 1.
  BILLET_INLINE static Real compute_distortion(const Material &material, const Real x, const Real i2,
                                               const Real i3) {
    return (1.5_r * material.shear) * (i2 * x - i3) / (x * (x + 1._r) + 1._r);
  }

  /// Sets b̄_e = dev τ/G + x 1 with the x for which det b̄_e = 1: x³ − i2 x + i3 − 1 = 0. In H this
  /// adds only a multiple of j⁻¹ j⁻ᵀ.
  BILLET_INLINE static void flow(const Material &material, const Map &map, const Mask yields,
                                 const Real scale, const Real mean_bar, const Real beta,
                                 const Real dev_tau[6], Number *history, Watch &watch) {
    const Number flexibility = 1._r / material.shear;
    const Real i2 = (0.5_r * flexibility * flexibility) * contract(dev_tau, dev_tau);
    const Real i3 = (flexibility * flexibility * flexibility) * determinant(dev_tau);
    Real x = 1._r + i2 * (1._r / 3._r) - i3 * (1._r / 3._r), correction;
    unsigned int iteration = 0;
    do {
      correction = (x * (x * x - i2) + i3 - 1._r) / (3._r * x * x - i2);
      x -= correction;
    } while (any(abs(correction) > 1e-9_r) && ++iteration < 20);
    watch.distortion = compute_distortion(material, x, i2, i3);
    const Real share = (x - beta * mean_bar) / scale * map.inverse_det * map.inverse_det;
    Real metric[6];
    map.compute_metric(metric);
    for (unsigned int k = 0; k < 6; ++k) {
      const Real h = load(history + k * n_lanes);
      store(history + k * n_lanes, select(yields, beta * h + share * metric[k], h));
    }
  }

  /// Sets b̄_e = dev τ/G + (1 + z) 1, the same with z: z (3 + z (3 + z)) − i2 (1 + z) + i3 = 0.
  BILLET_INLINE static void flow(const Material &material, const Mask yields, const Real dev_tau[6],
                                 Strain &strain, Watch &watch) {
    const Number flexibility = 1._r / material.shear;
    const Real i2 = (0.5_r * flexibility * flexibility) * contract(dev_tau, dev_tau);
    const Real i3 = (flexibility * flexibility * flexibility) * determinant(dev_tau);
    Real z = (i2 - i3) * (1._r / 3._r), correction;
    unsigned int iteration = 0;
    do {
      correction =
          (z * (3._r + z * (3._r + z)) - i2 * (1._r + z) + i3) / (3._r * (1._r + z) * (1._r + z) - i2);
      z -= correction;
    } while (any(abs(correction) > 1e-5_r) && ++iteration < 20);
    watch.distortion = compute_distortion(material, 1._r + z, i2, i3);
    for (unsigned int k = 0; k < 6; ++k)
      strain.y[k] = select(yields, flexibility * dev_tau[k] + (k < 3 ? z : Real{}), strain.y[k]);
  }
};

/// Rate form: dev τ ← R dev τ Rᵀ + 2 G dev sym ΔL, ΔL = ∂Δu/∂x at mid-step, and R = (1 − W/2)⁻¹
/// (1 + W/2), W = skew ΔL (Hughes & Winget 1980).
struct Hypoelastic {
  template <bool is_plastic>
  BILLET_INLINE static void update(const Material &material, const LaneFunctions &functions,
                                   const Map &middle, const Real delta[3][3], const Real hourglass,
                                   Number *history, Real dev_tau[6], Watch &watch) {
    Real l[3][3]; // ΔL
    compute_gradient(middle, delta, l);
    rotate(l, history, dev_tau);
    const Real mean = (l[0][0] + l[1][1] + l[2][2]) * (1._r / 3._r);
    for (unsigned int k = 0; k < 3; ++k)
      dev_tau[k] += (2._r * material.shear) * (l[k][k] - mean);
    for (unsigned int k = 3; k < 6; ++k)
      dev_tau[k] += material.shear * (l[column_of[k]][row_of[k]] + l[row_of[k]][column_of[k]]);

    const Real own = 1.5_r * contract(dev_tau, dev_tau);
    const Real q = square_root(own + hourglass);
    Mask yields{};
    const Real beta = return_map<is_plastic>(material, functions, q, broadcast(3._r * material.shear),
                                             history + 5 * n_lanes, yields, watch);
    watch.mises = max(watch.mises, beta * q);
    watch.distortion = beta * beta * own * (1._r / (6._r * material.shear));
    watch.share = beta;
    if (is_plastic)
      for (unsigned int k = 0; k < 6; ++k)
        dev_tau[k] *= beta;
    store(history, dev_tau[0]);
    store(history + n_lanes, dev_tau[1]);
    for (unsigned int k = 3; k < 6; ++k)
      store(history + (k - 1) * n_lanes, dev_tau[k]);
  }

  BILLET_INLINE static void rotate(const Real l[3][3], const Number *history, Real dev_tau[6]) {
    Real s[6];
    s[0] = load(history);
    s[1] = load(history + n_lanes);
    s[2] = -s[0] - s[1];
    for (unsigned int k = 3; k < 6; ++k)
      s[k] = load(history + (k - 1) * n_lanes);
    // W is the cross product with w; R = 1 + (W + W²/2)/(1 + w²/4).
    const Real w[3] = {0.5_r * (l[1][2] - l[2][1]), 0.5_r * (l[2][0] - l[0][2]), 0.5_r * (l[0][1] - l[1][0])};
    const Real w2 = dot(w, w);
    const Real a = 1._r / (1._r + 0.25_r * w2);
    Real r[3][3];
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        r[k][i] = (0.5_r * a) * (w[i] * w[k] - (i == k ? w2 : Real{})) + (i == k && !is_single ? 1._r : 0._r);
    for (unsigned int k = 0; k < 3; ++k) {
      const unsigned int i = (k + 1) % 3, m = (k + 2) % 3;
      r[i][m] += a * w[k]; // W_mi = w_k, W_im = −w_k
      r[m][i] -= a * w[k];
    }
    if constexpr (is_single) { // r is R − 1: no cancellation error for small rotations
      Real m[3][3], change[6];
      multiply(r, s, m);
      compute_change(r, m, change);
      for (unsigned int k = 0; k < 6; ++k)
        dev_tau[k] = s[k] + change[k];
    } else
      push(r, s, dev_tau);
  }
};

template <class Law> constexpr bool is_rate_form = false;
template <> constexpr bool is_rate_form<Hypoelastic> = true;

} // namespace
} // namespace billet::explicit_kernels

#endif
