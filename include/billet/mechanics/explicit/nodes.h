// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_EXPLICIT_NODES_H
#define BILLET_MECHANICS_EXPLICIT_NODES_H

#include "billet/mechanics/explicit/lanes.h"

// Conversion of nodal vectors, rows of four doubles, to lanes and back.

namespace billet::explicit_kernels {
namespace {

#if !BILLET_SINGLE

#if BILLET_LANES >= 4
using Row = double __attribute__((vector_size(32)));

BILLET_INLINE Row load_row(const double *p) { return *reinterpret_cast<const Row *>(p); }

/// Gets x, y, z of four nodes from four rows (x, y, z, unused).
BILLET_INLINE void transpose(const Row a, const Row b, const Row c, const Row d, Row &x, Row &y, Row &z) {
  const Row t0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), t1 = __builtin_shufflevector(a, b, 1, 5, 3, 7),
            t2 = __builtin_shufflevector(c, d, 0, 4, 2, 6), t3 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  x = __builtin_shufflevector(t0, t2, 0, 1, 4, 5);
  y = __builtin_shufflevector(t1, t3, 0, 1, 4, 5);
  z = __builtin_shufflevector(t0, t2, 2, 3, 6, 7);
}

/// Inverse of transpose().
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

/// Gathers p (+ q, if `add`) of one node of each element.
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

/// Subtracts the forces of all nodes, one element after another, since elements of a batch may
/// share nodes.
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

#else // float

#if BILLET_LANES == 1

/// Vector of an element's first node, multiplied by a scale. gather_from() returns differences from
/// it, computed in double and then rounded.
struct FirstNode {
  double vector[3];
};

BILLET_INLINE void scale_first(const double *p, const double scale, const std::uint32_t *nodes,
                               FirstNode &first) {
  for (unsigned int i = 0; i < 3; ++i)
    first.vector[i] = scale * p[4 * std::size_t{nodes[0]} + i];
}

BILLET_INLINE void gather_from(const FirstNode &first, const double *p, const double scale,
                               const std::uint32_t *nodes, Real x[3]) {
  for (unsigned int i = 0; i < 3; ++i)
    x[i] = static_cast<float>(scale * p[4 * std::size_t{nodes[0]} + i] - first.vector[i]);
}

/// Subtracts the forces of all nodes; the force of the first node balances the others, in double.
BILLET_INLINE void scatter(const Real f[8][3], const std::uint32_t *nodes, const std::size_t,
                           const double unit, double *forces) {
  for (unsigned int i = 0; i < 3; ++i) {
    double sum = 0.;
    for (unsigned int a = 1; a < 8; ++a) {
      const double force = unit * f[a][i];
      forces[4 * std::size_t{nodes[a]} + i] -= force;
      sum += force;
    }
    forces[4 * std::size_t{nodes[0]} + i] += sum;
  }
}

#else

using Row = double __attribute__((vector_size(32)));
using FloatRow = float __attribute__((vector_size(16)));

BILLET_INLINE const Row &row_of_node(const double *p, const std::uint32_t node) {
  return *reinterpret_cast<const Row *>(p + 4 * std::size_t{node});
}

/// Vectors of the elements' first nodes, multiplied by a scale.
struct FirstNode {
  Row vector[n_lanes];
};

BILLET_INLINE void scale_first(const double *p, const double scale, const std::uint32_t *nodes,
                               FirstNode &first) {
  for (std::size_t lane = 0; lane < n_lanes; ++lane)
    first.vector[lane] = scale * row_of_node(p, nodes[lane]);
}

/// Returns the numbers i, j, k, l of each block of four lanes; those of the second vector start at
/// `other`.
template <int i, int j, int k, int l> BILLET_INLINE Real shuffle(const Real &a, const Real &b) {
#if BILLET_LANES == 16
  return __builtin_shufflevector(a, b, i, j, k, l, i + 4, j + 4, k + 4, l + 4, i + 8, j + 8, k + 8, l + 8,
                                 i + 12, j + 12, k + 12, l + 12);
#elif BILLET_LANES == 8
  return __builtin_shufflevector(a, b, i, j, k, l, i + 4, j + 4, k + 4, l + 4);
#else
  return __builtin_shufflevector(a, b, i, j, k, l);
#endif
}
constexpr int other = n_lanes;

/// Gets x, y, z from four vectors of rows; the k-th vector holds the elements k, k + 4, k + 8 and
/// k + 12.
BILLET_INLINE void transpose(const Real rows[4], Real x[3]) {
  const Real t0 = shuffle<0, other, 1, other + 1>(rows[0], rows[1]),
             t1 = shuffle<2, other + 2, 3, other + 3>(rows[0], rows[1]),
             t2 = shuffle<0, other, 1, other + 1>(rows[2], rows[3]),
             t3 = shuffle<2, other + 2, 3, other + 3>(rows[2], rows[3]);
  x[0] = shuffle<0, 1, other, other + 1>(t0, t2);
  x[1] = shuffle<2, 3, other + 2, other + 3>(t0, t2);
  x[2] = shuffle<0, 1, other, other + 1>(t1, t3);
}

/// Inverse of transpose().
BILLET_INLINE void transpose_back(const Real x[3], Real rows[4]) {
  const Real zero{};
  const Real t0 = shuffle<0, other, 1, other + 1>(x[0], x[1]),
             t1 = shuffle<2, other + 2, 3, other + 3>(x[0], x[1]),
             t2 = shuffle<0, other, 1, other + 1>(x[2], zero),
             t3 = shuffle<2, other + 2, 3, other + 3>(x[2], zero);
  rows[0] = shuffle<0, 1, other, other + 1>(t0, t2);
  rows[1] = shuffle<2, 3, other + 2, other + 3>(t0, t2);
  rows[2] = shuffle<0, 1, other, other + 1>(t1, t3);
  rows[3] = shuffle<2, 3, other + 2, other + 3>(t1, t3);
}

/// Returns rows of four numbers, concatenated.
BILLET_INLINE Real stack_rows(const FloatRow rows[n_lanes / 4]) {
#if BILLET_LANES == 16
  __m512 x = _mm512_castps128_ps512(rows[0]);
  x = _mm512_castpd_ps(_mm512_insertf64x2(_mm512_castps_pd(x), _mm_castps_pd(rows[1]), 1));
  x = _mm512_castpd_ps(_mm512_insertf64x2(_mm512_castps_pd(x), _mm_castps_pd(rows[2]), 2));
  return _mm512_castpd_ps(_mm512_insertf64x2(_mm512_castps_pd(x), _mm_castps_pd(rows[3]), 3));
#elif BILLET_LANES == 8
  return _mm256_insertf128_ps(_mm256_castps128_ps256(rows[0]), rows[1], 1);
#else
  return rows[0];
#endif
}

BILLET_INLINE void unstack_rows(const Real &x, FloatRow rows[n_lanes / 4]) {
#if BILLET_LANES == 4
  rows[0] = x;
#else
  rows[0] = __builtin_shufflevector(x, x, 0, 1, 2, 3);
  rows[1] = __builtin_shufflevector(x, x, 4, 5, 6, 7);
#endif
#if BILLET_LANES == 16
  rows[2] = __builtin_shufflevector(x, x, 8, 9, 10, 11);
  rows[3] = __builtin_shufflevector(x, x, 12, 13, 14, 15);
#endif
}

/// Gathers `scale` p of one node of each element minus the first node's vector: the difference in
/// double, then rounded.
BILLET_INLINE void gather_from(const FirstNode &first, const double *p, const double scale,
                               const std::uint32_t *nodes, Real x[3]) {
  Real rows[4];
  for (unsigned int k = 0; k < 4; ++k) {
    FloatRow stack[n_lanes / 4];
    for (unsigned int block = 0; block < n_lanes / 4; ++block) {
      const std::size_t lane = 4 * block + k;
      const Row difference = scale * row_of_node(p, nodes[lane]) - first.vector[lane];
      stack[block] = __builtin_convertvector(difference, FloatRow);
    }
    rows[k] = stack_rows(stack);
  }
  transpose(rows, x);
}

/// Subtracts the forces of all nodes, one element after another, since elements of a batch may
/// share nodes. The force of the first node balances the others, in double.
BILLET_INLINE void scatter(const Real f[8][3], const std::uint32_t *nodes, const std::size_t n,
                           const double unit, double *forces) {
  FloatRow rows[8][4][n_lanes / 4];
  for (unsigned int a = 1; a < 8; ++a) {
    Real transposed[4];
    transpose_back(f[a], transposed);
    for (unsigned int k = 0; k < 4; ++k)
      unstack_rows(transposed[k], rows[a][k]);
  }
  for (std::size_t lane = 0; lane < n; ++lane) {
    Row sum{};
    for (unsigned int a = 1; a < 8; ++a) {
      const Row force = unit * __builtin_convertvector(rows[a][lane % 4][lane / 4], Row);
      *reinterpret_cast<Row *>(forces + 4 * std::size_t{nodes[a * n_lanes + lane]}) -= force;
      sum += force;
    }
    *reinterpret_cast<Row *>(forces + 4 * std::size_t{nodes[lane]}) += sum;
  }
}

#endif

#endif

} // namespace
} // namespace billet::explicit_kernels

#endif
