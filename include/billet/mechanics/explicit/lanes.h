// SPDX-License-Identifier: LGPL-2.1-or-later
// A translation unit defines BILLET_LANES, how many elements it computes at once, before it includes this.
#ifndef BILLET_MECHANICS_EXPLICIT_LANES_H
#define BILLET_MECHANICS_EXPLICIT_LANES_H

#include "billet/mechanics/explicit/kernel.h"

#if defined(__AVX__) || defined(__SSE2__)
#include <immintrin.h>
#endif

#define BILLET_INLINE inline __attribute__((always_inline))

// Everything here is in an unnamed namespace: each instruction set has its own.
namespace billet::explicit_kernels {
namespace {

constexpr std::size_t n_lanes = BILLET_LANES;

#if BILLET_LANES == 1
using Real = double;
using Mask = bool;
using Bits = unsigned long long;
BILLET_INLINE double get(const Real x, const std::size_t) { return x; }
BILLET_INLINE void set(Real &x, const std::size_t, const double value) { x = value; }
BILLET_INLINE bool get_mask(const Mask m, const std::size_t) { return m; }
BILLET_INLINE void set_mask(Mask &m, const std::size_t) { m = true; }
BILLET_INLINE bool any(const Mask m) { return m; }
BILLET_INLINE Real square_root(const Real x) { return __builtin_sqrt(x); }
#else
using Real = double __attribute__((vector_size(8 * BILLET_LANES)));
using Mask = long long __attribute__((vector_size(8 * BILLET_LANES)));
using Bits = unsigned long long __attribute__((vector_size(8 * BILLET_LANES)));
BILLET_INLINE double get(const Real &x, const std::size_t lane) { return x[lane]; }
BILLET_INLINE void set(Real &x, const std::size_t lane, const double value) { x[lane] = value; }
BILLET_INLINE bool get_mask(const Mask &m, const std::size_t lane) { return m[lane] != 0; }
BILLET_INLINE void set_mask(Mask &m, const std::size_t lane) { m[lane] = -1; }
#if BILLET_LANES == 8
BILLET_INLINE bool any(const Mask m) {
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(m), reinterpret_cast<__m512i>(m)) != 0;
}
BILLET_INLINE Real square_root(const Real x) { return _mm512_maskz_sqrt_pd(0xff, x); }
#elif BILLET_LANES == 4
BILLET_INLINE bool any(const Mask m) { return _mm256_movemask_pd(reinterpret_cast<__m256d>(m)) != 0; }
BILLET_INLINE Real square_root(const Real x) { return _mm256_sqrt_pd(x); }
#else
BILLET_INLINE bool any(const Mask m) { return _mm_movemask_pd(reinterpret_cast<__m128d>(m)) != 0; }
BILLET_INLINE Real square_root(const Real x) { return _mm_sqrt_pd(x); }
#endif
#endif

BILLET_INLINE Real broadcast(const double x) { return Real{} + x; }
BILLET_INLINE Real select(const Mask m, const Real a, const Real b) { return m ? a : b; }
BILLET_INLINE Real max(const Real a, const Real b) { return a > b ? a : b; }
BILLET_INLINE Real min(const Real a, const Real b) { return a < b ? a : b; }
BILLET_INLINE Real abs(const Real a) { return max(a, -a); }
BILLET_INLINE Real load(const double *p) { return *reinterpret_cast<const Real *>(p); }
BILLET_INLINE void store(double *p, const Real x) { *reinterpret_cast<Real *>(p) = x; }

inline double sum_lanes(const Real x) {
  double sum = 0.;
  for (std::size_t lane = 0; lane < n_lanes; ++lane)
    sum += get(x, lane);
  return sum;
}
inline double largest_lane(const Real x) {
  double largest = get(x, 0);
  for (std::size_t lane = 1; lane < n_lanes; ++lane)
    largest = get(x, lane) > largest ? get(x, lane) : largest;
  return largest;
}

/// 1/k and 1/k!.
struct SeriesCoefficients {
  double reciprocal[40] = {}, inverse_factorial[40] = {1.};
  constexpr SeriesCoefficients() {
    for (unsigned int k = 1; k < 40; ++k) {
      reciprocal[k] = 1. / k;
      inverse_factorial[k] = inverse_factorial[k - 1] / k;
    }
  }
};
constexpr SeriesCoefficients series;

BILLET_INLINE Bits to_bits(const Real x) {
  Bits bits;
  __builtin_memcpy(&bits, &x, sizeof(x));
  return bits;
}
BILLET_INLINE Real from_bits(const Bits bits) {
  Real x;
  __builtin_memcpy(&x, &bits, sizeof(x));
  return x;
}

constexpr double two_52 =
    6755399441055744.; ///< 1.5 · 2⁵²: in x + two_52 the last bits are the integer next to x

/// ln x of positive x.
BILLET_INLINE Real logarithm(const Real x) {
  // x = 2ᵏ m with m from √½ to √2; ln m = 2 artanh y, |y| ≤ 0.172: what is left out is below 1e-17 of it
  const Bits bits = to_bits(x);
  const Bits k = ((bits - 0x3fe6a09e667f3bcdULL + (1024ULL << 52)) >> 52) - 1024ULL;
  const Real exponent = from_bits(k + 0x4338000000000000ULL) - two_52;
  const Real m = from_bits(bits - (k << 52));
  const Real y = (m - 1.) / (m + 1.);
  const Real z = y * y;
  Real sum = broadcast(1. / 21.);
  sum = sum * z + 1. / 19.;
  sum = sum * z + 1. / 17.;
  sum = sum * z + 1. / 15.;
  sum = sum * z + 1. / 13.;
  sum = sum * z + 1. / 11.;
  sum = sum * z + 1. / 9.;
  sum = sum * z + 1. / 7.;
  sum = sum * z + 1. / 5.;
  sum = sum * z + 1. / 3.;
  sum = sum * z + 1.;
  return exponent * 0.693147180559945309417 + 2. * y * sum;
}

/// exp x; beyond ±700 that of ±700.
BILLET_INLINE Real exponential(const Real x) {
  const Real bounded = min(max(x, broadcast(-700.)), broadcast(700.));
  // x = k ln 2 + r, the logarithm in two parts; |r| ≤ 0.35, what is left out is below 1e-17
  const Real shifted = bounded * 1.44269504088896340736 + two_52;
  const Real k = shifted - two_52;
  const Real r = (bounded - k * 0.693147180369123816490) - k * 1.90821492927058770002e-10;
  Real sum = broadcast(series.inverse_factorial[14]);
  for (unsigned int n = 14; n >= 1; --n)
    sum = sum * r + series.inverse_factorial[n - 1];
  return sum * from_bits((to_bits(shifted) << 52) + (1023ULL << 52));
}

/// x^{-1/3} of positive x.
BILLET_INLINE Real inverse_cube_root(const Real x) {
  // The guess divides the exponent by −3, fraction and all: i/3 = i/4 + i/16 + i/64 + ... It is good to 4 %;
  // then y (1 + e/3 + 2 e²/9 + ...), e = 1 − x y³, with four terms and with two.
  const Bits bits = to_bits(x);
  Bits third = (bits >> 2) + (bits >> 4);
  third += third >> 4;
  third += third >> 8;
  Real y = from_bits(0x553ef0ff289dd796ULL - third);
  Real e = 1. - x * y * y * y;
  y += y * e * (1. / 3. + e * (2. / 9. + e * (14. / 81. + e * (35. / 243.))));
  e = 1. - x * y * y * y;
  return y + y * e * (1. / 3. + e * (2. / 9.));
}

#if BILLET_LANES >= 4
using Row = double __attribute__((vector_size(32)));

BILLET_INLINE Row load_row(const double *p) { return *reinterpret_cast<const Row *>(p); }

/// x, y, z of four nodes from four rows (x, y, z, unused).
BILLET_INLINE void transpose(const Row a, const Row b, const Row c, const Row d, Row &x, Row &y, Row &z) {
  const Row t0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), t1 = __builtin_shufflevector(a, b, 1, 5, 3, 7),
            t2 = __builtin_shufflevector(c, d, 0, 4, 2, 6), t3 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  x = __builtin_shufflevector(t0, t2, 0, 1, 4, 5);
  y = __builtin_shufflevector(t1, t3, 0, 1, 4, 5);
  z = __builtin_shufflevector(t0, t2, 2, 3, 6, 7);
}

/// The other way.
BILLET_INLINE void transpose_back(const Row x, const Row y, const Row z, Row row[4]) {
  const Row zero{};
  const Row t0 = __builtin_shufflevector(x, y, 0, 4, 2, 6), t1 = __builtin_shufflevector(x, y, 1, 5, 3, 7),
            t2 = __builtin_shufflevector(z, zero, 0, 4, 2, 6),
            t3 = __builtin_shufflevector(z, zero, 1, 5, 3, 7);
  row[0] = __builtin_shufflevector(t0, t2, 0, 1, 4, 5);
  row[1] = __builtin_shufflevector(t1, t3, 0, 1, 4, 5);
  row[2] = __builtin_shufflevector(t0, t2, 2, 3, 6, 7);
  row[3] = __builtin_shufflevector(t1, t3, 2, 3, 6, 7);
}
#endif

/// p (+ q, if given) of one node of each element.
template <bool add>
BILLET_INLINE void gather(const double *p, const double *q, const std::uint32_t *nodes, Real x[3]) {
#if BILLET_LANES >= 4
  Row rows[n_lanes];
  for (std::size_t lane = 0; lane < n_lanes; ++lane) {
    rows[lane] = load_row(p + 4 * std::size_t{nodes[lane]});
    if (add)
      rows[lane] += load_row(q + 4 * std::size_t{nodes[lane]});
  }
#if BILLET_LANES == 4
  transpose(rows[0], rows[1], rows[2], rows[3], x[0], x[1], x[2]);
#else
  Row low[3], high[3];
  transpose(rows[0], rows[1], rows[2], rows[3], low[0], low[1], low[2]);
  transpose(rows[4], rows[5], rows[6], rows[7], high[0], high[1], high[2]);
  for (unsigned int i = 0; i < 3; ++i)
    x[i] = __builtin_shufflevector(low[i], high[i], 0, 1, 2, 3, 4, 5, 6, 7);
#endif
#else
  for (std::size_t lane = 0; lane < n_lanes; ++lane)
    for (unsigned int i = 0; i < 3; ++i) {
      const std::size_t k = 4 * std::size_t{nodes[lane]} + i;
      set(x[i], lane, add ? p[k] + q[k] : p[k]);
    }
#endif
}

/// Subtracts the forces of all nodes, element after element: elements of a batch may share nodes.
BILLET_INLINE void scatter(const Real f[8][3], const std::uint32_t *nodes, const std::size_t n,
                           double *forces) {
#if BILLET_LANES >= 4
  Row rows[8][n_lanes];
  for (unsigned int a = 0; a < 8; ++a) {
#if BILLET_LANES == 4
    transpose_back(f[a][0], f[a][1], f[a][2], rows[a]);
#else
    Row low[3], high[3];
    for (unsigned int i = 0; i < 3; ++i) {
      low[i] = __builtin_shufflevector(f[a][i], f[a][i], 0, 1, 2, 3);
      high[i] = __builtin_shufflevector(f[a][i], f[a][i], 4, 5, 6, 7);
    }
    transpose_back(low[0], low[1], low[2], rows[a]);
    transpose_back(high[0], high[1], high[2], rows[a] + 4);
#endif
  }
  for (std::size_t lane = 0; lane < n; ++lane)
    for (unsigned int a = 0; a < 8; ++a)
      *reinterpret_cast<Row *>(forces + 4 * std::size_t{nodes[a * n_lanes + lane]}) -= rows[a][lane];
#else
  for (std::size_t lane = 0; lane < n; ++lane)
    for (unsigned int a = 0; a < 8; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        forces[4 * std::size_t{nodes[a * n_lanes + lane]} + i] -= get(f[a][i], lane);
#endif
}

} // namespace
} // namespace billet::explicit_kernels

#endif
