// SPDX-License-Identifier: LGPL-2.1-or-later
// A translation unit defines two macros before it includes this file. BILLET_LANES is the number of
// elements computed at once; BILLET_SINGLE is 1 for float or 0 for double.
#ifndef BILLET_MECHANICS_EXPLICIT_LANES_H
#define BILLET_MECHANICS_EXPLICIT_LANES_H

#include "billet/mechanics/explicit/kernel.h"

#if defined(__AVX__) || defined(__SSE2__)
#include <immintrin.h>
#endif

#define BILLET_INLINE inline __attribute__((always_inline))

// Everything here is in an unnamed namespace: each instruction set and number type has its own
// copy.
namespace billet::explicit_kernels {
namespace {

constexpr std::size_t n_lanes = BILLET_LANES;
#if BILLET_SINGLE
using Number = float;
#else
using Number = double;
#endif
using Hardening = BasicHardening<Number>;
using Material = BasicMaterial<Number>;
using Elements = BasicElements<Number>;

constexpr bool is_single = sizeof(Number) == 4;

/// Literals of type Number.
constexpr Number operator""_r(const long double x) { return static_cast<Number>(x); }

/// Integers as wide as the numbers.
template <class T> struct IntegersOf;
template <> struct IntegersOf<double> {
  using Signed = long long;
  using Unsigned = unsigned long long;
};
template <> struct IntegersOf<float> {
  using Signed = int;
  using Unsigned = unsigned int;
};
using Integer = IntegersOf<Number>::Unsigned;

#if BILLET_LANES == 1
using Real = Number;
using Mask = bool;
using Bits = Integer;
BILLET_INLINE Number get(const Real x, const std::size_t) { return x; }
BILLET_INLINE void set(Real &x, const std::size_t, const Number value) { x = value; }
BILLET_INLINE bool get_mask(const Mask m, const std::size_t) { return m; }
BILLET_INLINE void set_mask(Mask &m, const std::size_t) { m = true; }
BILLET_INLINE bool any(const Mask m) { return m; }
BILLET_INLINE double square_root(const double x) { return __builtin_sqrt(x); }
BILLET_INLINE float square_root(const float x) { return __builtin_sqrtf(x); }
#else
using Real = Number __attribute__((vector_size(sizeof(Number) * BILLET_LANES)));
using Mask = IntegersOf<Number>::Signed __attribute__((vector_size(sizeof(Number) * BILLET_LANES)));
using Bits = Integer __attribute__((vector_size(sizeof(Number) * BILLET_LANES)));
BILLET_INLINE Number get(const Real &x, const std::size_t lane) { return x[lane]; }
BILLET_INLINE void set(Real &x, const std::size_t lane, const Number value) { x[lane] = value; }
BILLET_INLINE bool get_mask(const Mask &m, const std::size_t lane) { return m[lane] != 0; }
BILLET_INLINE void set_mask(Mask &m, const std::size_t lane) { m[lane] = -1; }

// Operations on full registers with lanes of 4 or 8 bytes. The argument is a vector in both cases.
#if defined(__AVX512F__)
using DoubleRegister = __m512d;
using FloatRegister = __m512;
BILLET_INLINE bool any_of(const __m512d m) {
  return _mm512_test_epi64_mask(_mm512_castpd_si512(m), _mm512_castpd_si512(m)) != 0;
}
BILLET_INLINE bool any_of(const __m512 m) {
  return _mm512_test_epi32_mask(_mm512_castps_si512(m), _mm512_castps_si512(m)) != 0;
}
BILLET_INLINE __m512d root_of(const __m512d x) { return _mm512_maskz_sqrt_pd(0xff, x); }
BILLET_INLINE __m512 root_of(const __m512 x) { return _mm512_maskz_sqrt_ps(0xffff, x); }
#elif defined(__AVX__)
using DoubleRegister = __m256d;
using FloatRegister = __m256;
BILLET_INLINE bool any_of(const __m256d m) { return _mm256_movemask_pd(m) != 0; }
BILLET_INLINE bool any_of(const __m256 m) { return _mm256_movemask_ps(m) != 0; }
BILLET_INLINE __m256d root_of(const __m256d x) { return _mm256_sqrt_pd(x); }
BILLET_INLINE __m256 root_of(const __m256 x) { return _mm256_sqrt_ps(x); }
#else
using DoubleRegister = __m128d;
using FloatRegister = __m128;
BILLET_INLINE bool any_of(const __m128d m) { return _mm_movemask_pd(m) != 0; }
BILLET_INLINE bool any_of(const __m128 m) { return _mm_movemask_ps(m) != 0; }
BILLET_INLINE __m128d root_of(const __m128d x) { return _mm_sqrt_pd(x); }
BILLET_INLINE __m128 root_of(const __m128 x) { return _mm_sqrt_ps(x); }
#endif
template <bool> struct RegisterOf;
template <> struct RegisterOf<false> { using Type = DoubleRegister; };
template <> struct RegisterOf<true> { using Type = FloatRegister; };
using Register = RegisterOf<is_single>::Type;
BILLET_INLINE bool any(const Mask m) { return any_of(reinterpret_cast<Register>(m)); }
BILLET_INLINE Real square_root(const Real x) { return root_of(x); }
BILLET_INLINE Number square_root(const Number x) {
  if constexpr (is_single)
    return __builtin_sqrtf(static_cast<float>(x));
  else
    return static_cast<Number>(__builtin_sqrt(x));
}
#endif

BILLET_INLINE Real broadcast(const Number x) { return Real{} + x; }
BILLET_INLINE Real select(const Mask m, const Real a, const Real b) { return m ? a : b; }
BILLET_INLINE Real max(const Real a, const Real b) { return a > b ? a : b; }
BILLET_INLINE Real min(const Real a, const Real b) { return a < b ? a : b; }
BILLET_INLINE Real abs(const Real a) { return max(a, -a); }
BILLET_INLINE Real load(const Number *p) { return *reinterpret_cast<const Real *>(p); }
BILLET_INLINE void store(Number *p, const Real x) { *reinterpret_cast<Real *>(p) = x; }

inline Number max_lane(const Real x) {
  Number maximum = get(x, 0);
  for (std::size_t lane = 1; lane < n_lanes; ++lane)
    maximum = get(x, lane) > maximum ? get(x, lane) : maximum;
  return maximum;
}

/// Coefficients 1/k and 1/k!.
struct SeriesCoefficients {
  Number reciprocal[40] = {}, inverse_factorial[40] = {1._r};
  constexpr SeriesCoefficients() {
    for (unsigned int k = 1; k < 40; ++k) {
      reciprocal[k] = 1._r / static_cast<Number>(k);
      inverse_factorial[k] = inverse_factorial[k - 1] / static_cast<Number>(k);
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

/// Floating-point format of the type, and constants that depend on it.
template <class T> struct FormatOf;
template <> struct FormatOf<double> {
  static constexpr unsigned int n_fraction = 52; ///< bits
  static constexpr IntegersOf<double>::Unsigned bias = 1023, root_half = 0x3fe6a09e667f3bcdULL;
  /// 1.5 · 2⁵²: in x + shift the last bits are the integer next to x.
  static constexpr double shift = 6755399441055744.;
  static constexpr IntegersOf<double>::Unsigned shift_bits = 0x4338000000000000ULL;
  static constexpr IntegersOf<double>::Unsigned inverse_cube_root = 0x553ef0ff289dd796ULL;
  static constexpr double max_exponent = 700.;
  static constexpr unsigned int n_artanh = 10, n_exponential = 14; ///< terms beyond the first
  static constexpr double ln_2_high = 0.693147180369123816490, ln_2_low = 1.90821492927058770002e-10;
};
template <> struct FormatOf<float> {
  static constexpr unsigned int n_fraction = 23;
  static constexpr IntegersOf<float>::Unsigned bias = 127, root_half = 0x3f3504f3U;
  static constexpr float shift = 12582912.F; ///< 1.5 · 2²³
  static constexpr IntegersOf<float>::Unsigned shift_bits = 0x4b400000U;
  static constexpr IntegersOf<float>::Unsigned inverse_cube_root = 0x54a2fa8cU;
  static constexpr float max_exponent = 80.F;
  static constexpr unsigned int n_artanh = 5, n_exponential = 7;
  static constexpr float ln_2_high = 0.693359375F, ln_2_low = -2.12194440e-4F;
};
using Format = FormatOf<Number>;

/// Splits x = 2ᵏ m with m in [√½, √2]. Returns k.
BILLET_INLINE Real split(const Real x, Real &m) {
  constexpr Integer offset = Format::bias + 1;
  const Bits bits = to_bits(x);
  const Bits k = ((bits - Format::root_half + (offset << Format::n_fraction)) >> Format::n_fraction) - offset;
  m = from_bits(bits - (k << Format::n_fraction));
  return from_bits(k + Format::shift_bits) - Format::shift;
}

/// Returns ln m = 2 artanh y, y = (m − 1)/(m + 1), |y| ≤ 0.172. The relative truncation error is
/// below 1e-17 (float: 2e-11).
BILLET_INLINE Real double_artanh(const Real y) {
  const Real z = y * y;
  Real sum = broadcast(series.reciprocal[2 * Format::n_artanh + 1]);
  for (unsigned int n = Format::n_artanh; n >= 1; --n)
    sum = sum * z + series.reciprocal[2 * n - 1];
  return 2._r * y * sum;
}

/// Returns ln x for positive x.
BILLET_INLINE Real logarithm(const Real x) {
  Real m;
  const Real exponent = split(x, m);
  return exponent * 0.693147180559945309417_r + double_artanh((m - 1._r) / (m + 1._r));
}

/// Returns ln(1 + x) for x > −1, without cancellation error for small x.
BILLET_INLINE Real logarithm_of_one_plus(const Real x) {
  Real m;
  const Real exponent = split(1._r + x, m);
  const Mask is_near = exponent == Real{};
  const Real above = select(is_near, x, m - 1._r);
  return exponent * 0.693147180559945309417_r + double_artanh(above / (2._r + above));
}

/// Returns exp x; x is clipped to ±700 (float: ±80).
BILLET_INLINE Real exponential(const Real x) {
  const Real bounded = min(max(x, broadcast(-Format::max_exponent)), broadcast(Format::max_exponent));
  // x = k ln 2 + r, with ln 2 in two parts; |r| ≤ 0.35, the truncation error is below 1e-17 (float:
  // 6e-9)
  const Real shifted = bounded * 1.44269504088896340736_r + Format::shift;
  const Real k = shifted - Format::shift;
  const Real r = (bounded - k * Format::ln_2_high) - k * Format::ln_2_low;
  Real sum = broadcast(series.inverse_factorial[Format::n_exponential]);
  for (unsigned int n = Format::n_exponential; n >= 1; --n)
    sum = sum * r + series.inverse_factorial[n - 1];
  return sum * from_bits((to_bits(shifted) << Format::n_fraction) + (Format::bias << Format::n_fraction));
}

/// Returns x^{-1/3} for positive x.
BILLET_INLINE Real inverse_cube_root(const Real x) {
  // The initial guess divides exponent and fraction by −3: i/3 = i/4 + i/16 + i/64 + ... Its error
  // is at most 4 %. Two corrections y (1 + e/3 + 2 e²/9 + ...), e = 1 − x y³, follow, with four
  // terms and with two.
  const Bits bits = to_bits(x);
  Bits third = (bits >> 2) + (bits >> 4);
  third += third >> 4;
  third += third >> 8;
  Real y = from_bits(Format::inverse_cube_root - third);
  Real e = 1._r - x * y * y * y;
  y += y * e * (1._r / 3._r + e * (2._r / 9._r + e * (14._r / 81._r + e * (35._r / 243._r))));
  e = 1._r - x * y * y * y;
  return y + y * e * (1._r / 3._r + e * (2._r / 9._r));
}

} // namespace
} // namespace billet::explicit_kernels

#endif
