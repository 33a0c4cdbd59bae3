// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_STRAIN_MODES_H
#define BILLET_MECHANICS_STRAIN_MODES_H

// Assumed strains of a brick, (B1) to (B5) of doc/theory.md, and the conjugate forces. Implicit
// scenes, their derivatives (Dual) and the lanes of explicit kernels share this code, which is
// inlined. `Real` is the type of data that vary with the displacements, `Fixed` that of constants,
// `Number` that of literals. Symmetric tensors have the order 11, 22, 33, 12, 13, 23. For vectors
// per direction of the brick, v[k][i] is component i for direction k.
//
// Strains are represented by their products with the columns, h_ab = a_a·h a_b (B7). In this form
// most vectors of (B3) to (B5) have only one or two components, and only scalars remain: the metric
// a_a·a_b and a_a·b̂.

#include <type_traits>

#define BILLET_STRAIN inline __attribute__((always_inline))

namespace billet::strain_modes {

/// θ of (B4), (B5): the retained fraction of the parasitic shear. With 0, zero-energy modes exist
/// in ideally plastic flow; with 1, bending in plastic flow is up to 2 % stiffer.
constexpr double kept_shear = 0.5;

/// Index of a pair of directions.
constexpr unsigned int pair[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
constexpr unsigned int first_of[6] = {0, 1, 2, 0, 0, 1}, second_of[6] = {0, 1, 2, 1, 2, 2};

/// Constants that follow from the elastic moduli and from the ratios l_j/l_k of the undeformed edge
/// lengths, (B4). `share` is the part s of the bending of fibre j that remains bending; the rest is
/// shear. `shear` is that shear per bending, s θ_jk. `thinning` is x_k of (B3), `fourth` the share
/// of the fourth mode.
template <class Fixed> struct Constants {
  Fixed share[3][3], shear[3][3]; ///< [j][k], j ≠ k
  Fixed thinning[3];
  Fixed fourth;
};

/// Directions of a brick's mean deformation.
template <class Real> struct Frame {
  Real columns[3][3]; ///< a_k
  Real duals[3][3];   ///< a^k
  Real determinant;
  Real metric[6], inverse_metric[6]; ///< a_i·a_j, a^i·a^j
  Real inverse_squares[3];           ///< 1/l_k²
  Real inverse_lengths[3];
  Real square_heights[3]; ///< 1/|a^k|²
  Real heights[3];        ///< heights of a_k above the plane of the others
  Real inverse_areas[3];  ///< 1/|a_i × a_j|²
  /// [k][j], j ≠ k: d^j·a_k, the coefficient of a_j in the in-plane part of a_k.
  Real slopes[3][3];
};

/// Amplitudes of the strains that vary as ξ_k, and as the product of the two other coordinates.
template <class Real> struct Strains { Real linear[3][6], bilinear[3][6]; };

/// Products a_k·b̂_1, b̂_2, b̂_3, ĉ: [vector][k].
template <class Real> struct Products { Real of[4][3]; };

/// Thinning along the third direction: given by (B3), or free.
struct GivenThinning {};
template <class Real> struct FreeThinning {
  Real strain;   ///< X of (B8): the strain along the normal is −X ξ_3
  Real pressure; ///< P of (B9), conjugate to the in-plane stretch
};
template <class Thinning> constexpr bool is_free = !std::is_same_v<Thinning, GivenThinning>;

/// Forces of the hourglass vectors, and of the columns, on which strains depend by their metric and
/// by their products with the hourglass vectors.
template <class Real> struct Forces { Real hourglass[4][3], columns[3][3]; };

template <class Real, class Other> BILLET_STRAIN auto dot(const Real *a, const Other *b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Completes a frame whose `columns` are set; `invert` and `root` are 1/x and √x.
template <class Real, class Invert, class Root>
BILLET_STRAIN void complete(Frame<Real> &frame, const Invert &invert, const Root &root) {
  const auto &a = frame.columns;
  for (unsigned int k = 0; k < 3; ++k) {
    const Real *b = a[(k + 1) % 3], *c = a[(k + 2) % 3];
    frame.duals[k][0] = b[1] * c[2] - b[2] * c[1];
    frame.duals[k][1] = b[2] * c[0] - b[0] * c[2];
    frame.duals[k][2] = b[0] * c[1] - b[1] * c[0];
  }
  frame.determinant = dot(a[0], frame.duals[0]);
  const Real inverse = invert(frame.determinant);
  for (auto &dual : frame.duals)
    for (Real &component : dual)
      component = inverse * component;
  for (unsigned int r = 0; r < 6; ++r) {
    frame.metric[r] = dot(a[first_of[r]], a[second_of[r]]);
    frame.inverse_metric[r] = dot(frame.duals[first_of[r]], frame.duals[second_of[r]]);
  }
  const Real squared = inverse * inverse;
  for (unsigned int k = 0; k < 3; ++k) {
    frame.inverse_squares[k] = invert(frame.metric[k]);
    frame.inverse_lengths[k] = root(frame.inverse_squares[k]);
    frame.square_heights[k] = invert(frame.inverse_metric[k]);
    frame.heights[k] = root(frame.square_heights[k]);
    frame.inverse_areas[k] = squared * frame.square_heights[k];
    for (unsigned int j = 0; j < 3; ++j)
      if (j != k)
        frame.slopes[k][j] = Real{} - frame.inverse_metric[pair[j][k]] * frame.square_heights[k];
  }
}

template <class Real>
BILLET_STRAIN void multiply(const Frame<Real> &frame, const Real (*hourglass)[3], Products<Real> &products) {
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int k = 0; k < 3; ++k)
      products.of[m][k] = dot(frame.columns[k], hourglass[m]);
}

/// Bending strains that vary along k, in the fibres i and j: η of (B2), e = η_jj/l_j², and h_k of
/// (B3) without the thinning.
template <class Real> struct Bending {
  Real eta_ii, eta_jj, eta_ij, e_i, e_j;
  Real less;               ///< Σ (s − 1) e of both
  Real ii, jj, ij, ik, jk; ///< h_k; a_k has the strain of its in-plane part
  Real sum;                ///< in-plane stretch that drives the thinning
};

template <class Number, unsigned int k, class Fixed, class Real>
BILLET_STRAIN Bending<Real> bend(const Constants<Fixed> &constants, const Frame<Real> &frame,
                                 const Products<Real> &products) {
  constexpr unsigned int i = (k + 1) % 3, j = (k + 2) % 3;
  const Fixed s_i = constants.share[i][k], s_j = constants.share[j][k];
  const Real &g_ij = frame.metric[pair[i][j]], &p_i = frame.slopes[k][i], &p_j = frame.slopes[k][j];
  Bending<Real> h;
  h.eta_ii = products.of[j][i]; // fibre i varies with ξ_k by mode (i, k), at position j
  h.eta_jj = products.of[i][j];
  h.eta_ij = Number(0.5) * (products.of[i][i] + products.of[j][j]);
  h.e_i = frame.inverse_squares[i] * h.eta_ii;
  h.e_j = frame.inverse_squares[j] * h.eta_jj;
  h.less = (s_i - Number(1)) * h.e_i + (s_j - Number(1)) * h.e_j;
  h.ii = s_i * h.eta_ii;
  h.jj = s_j * h.eta_jj;
  h.ij = h.eta_ij + Number(0.5) * (g_ij * h.less);
  h.ik = p_i * h.ii + p_j * h.ij;
  h.jk = p_i * h.ij + p_j * h.jj;
  h.sum = frame.inverse_areas[k] *
          (frame.metric[j] * h.ii + frame.metric[i] * h.jj - (s_i + s_j) * (g_ij * h.eta_ij));
  return h;
}

/// Adds factor sym(a_j ⊗ a^k) to h; l is the third direction.
template <class Number, unsigned int j, unsigned int k, class Real>
BILLET_STRAIN void add_shear(const Frame<Real> &frame, const Real &factor, Real *h) {
  constexpr unsigned int l = 3 - j - k;
  const Real half = Number(0.5) * factor;
  h[k] += factor * frame.metric[pair[j][k]];
  h[pair[j][k]] += half * frame.metric[j];
  h[pair[k][l]] += half * frame.metric[pair[j][l]];
}

/// Sets h_k of (B3), without shear; e: [j][k].
template <class Number, unsigned int k, class Fixed, class Real, class Thinning>
BILLET_STRAIN void set_bending(const Constants<Fixed> &constants, const Frame<Real> &frame,
                               const Products<Real> &products, [[maybe_unused]] const Thinning &thinning,
                               Real (*e)[3], Real *h) {
  constexpr unsigned int i = (k + 1) % 3, j = (k + 2) % 3;
  const Bending<Real> bending = bend<Number, k>(constants, frame, products);
  e[i][k] = bending.e_i;
  e[j][k] = bending.e_j;
  h[i] = bending.ii;
  h[j] = bending.jj;
  h[pair[i][j]] = bending.ij;
  h[pair[i][k]] = bending.ik;
  h[pair[j][k]] = bending.jk;
  if constexpr (k == 2 && is_free<Thinning>)
    h[k] = frame.slopes[k][i] * bending.ik + frame.slopes[k][j] * bending.jk -
           frame.square_heights[k] * thinning.strain;
  else
    h[k] = frame.slopes[k][i] * bending.ik + frame.slopes[k][j] * bending.jk -
           constants.thinning[k] * (frame.square_heights[k] * bending.sum);
}

/// Sets the strain of the fourth mode, without shear. Returns θ e_j.
template <class Number, unsigned int j, class Fixed, class Real>
BILLET_STRAIN Real set_fourth(const Constants<Fixed> &constants, const Frame<Real> &frame,
                              const Products<Real> &products, Real *h) {
  constexpr unsigned int k = (j + 1) % 3, l = (j + 2) % 3;
  const Real e = constants.fourth * (frame.inverse_squares[j] * products.of[3][j]);
  const Real half = Number(0.5) * e, more = (Number(1.5) * e) * frame.inverse_squares[j];
  const Real &g_jk = frame.metric[pair[j][k]], &g_jl = frame.metric[pair[j][l]];
  const Real more_k = more * g_jk;
  h[j] = e * frame.metric[j];
  h[pair[j][k]] = e * g_jk;
  h[pair[j][l]] = e * g_jl;
  h[k] = more_k * g_jk - half * frame.metric[k];
  h[l] = more * (g_jl * g_jl) - half * frame.metric[l];
  h[pair[k][l]] = more_k * g_jl - half * frame.metric[pair[k][l]];
  return Number(kept_shear) * e;
}

/// Adds the shear of fibre j with k as the other direction: (B4), and that of the fourth mode.
template <class Number, unsigned int j, unsigned int k, class Fixed, class Real>
BILLET_STRAIN void add_shears(const Constants<Fixed> &constants, const Frame<Real> &frame, const Real &e,
                              const Real &fourth, Strains<Real> &strains) {
  // t_j ⊗ n_k = a_j ⊗ a^k times this.
  const Real slender = frame.inverse_lengths[j] * frame.heights[k];
  add_shear<Number, j, k>(frame, constants.shear[j][k] * (e * slender), strains.linear[j]);
  add_shear<Number, j, k>(frame, fourth * slender, strains.bilinear[k]);
}

/// Returns E of (B8): the stretch of the plane of the first two directions by bending, per ξ_3.
template <class Number, class Fixed, class Real>
BILLET_STRAIN Real compute_plane_stretch(const Constants<Fixed> &constants, const Frame<Real> &frame,
                                         const Products<Real> &products) {
  return bend<Number, 2>(constants, frame, products).sum;
}

/// Computes the strains (B3) to (B5); with a FreeThinning, (B8).
template <class Number, class Fixed, class Real, class Thinning = GivenThinning>
BILLET_STRAIN void compute_strains(const Constants<Fixed> &constants, const Frame<Real> &frame,
                                   const Products<Real> &products, Strains<Real> &strains,
                                   const Thinning &thinning = {}) {
  Real e[3][3];
  set_bending<Number, 0>(constants, frame, products, thinning, e, strains.linear[0]);
  set_bending<Number, 1>(constants, frame, products, thinning, e, strains.linear[1]);
  set_bending<Number, 2>(constants, frame, products, thinning, e, strains.linear[2]);
  const Real fourth[3] = {set_fourth<Number, 0>(constants, frame, products, strains.bilinear[0]),
                          set_fourth<Number, 1>(constants, frame, products, strains.bilinear[1]),
                          set_fourth<Number, 2>(constants, frame, products, strains.bilinear[2])};
  add_shears<Number, 0, 1>(constants, frame, e[0][1], fourth[0], strains);
  add_shears<Number, 0, 2>(constants, frame, e[0][2], fourth[0], strains);
  add_shears<Number, 1, 0>(constants, frame, e[1][0], fourth[1], strains);
  add_shears<Number, 1, 2>(constants, frame, e[1][2], fourth[1], strains);
  add_shears<Number, 2, 0>(constants, frame, e[2][0], fourth[2], strains);
  add_shears<Number, 2, 1>(constants, frame, e[2][1], fourth[2], strains);
}

/// Derivatives of a power by the metric, by ln l_j, by ln(height_k), and by the products.
template <class Real> struct Derivatives { Real metric[6], length[3], height[3], products[4][3]; };

/// Differentiates the power of a strain `factor` e sym(a_j ⊗ a^k) with stress T; l is the third
/// direction. Returns the derivative by e, and adds the others to `derivatives`. `factor` is
/// proportional to height_k/l_j.
template <class Number, unsigned int j, unsigned int k, class Real>
BILLET_STRAIN Real differentiate_shear(const Frame<Real> &frame, const Real &factor, const Real &e,
                                       const Real *T, Derivatives<Real> &derivatives) {
  constexpr unsigned int l = 3 - j - k;
  const Real by_e =
      factor * (T[k] * frame.metric[pair[j][k]] +
                Number(0.5) * (T[pair[j][k]] * frame.metric[j] + T[pair[k][l]] * frame.metric[pair[j][l]]));
  const Real both = factor * e, half = Number(0.5) * both, power = e * by_e;
  derivatives.metric[pair[j][k]] += both * T[k];
  derivatives.metric[j] += half * T[pair[j][k]];
  derivatives.metric[pair[j][l]] += half * T[pair[k][l]];
  derivatives.height[k] += power;
  derivatives.length[j] -= power;
  return by_e;
}

/// Adds the derivatives for the part of the fourth mode that depends on fibre j.
template <class Number, unsigned int j, class Fixed, class Real>
BILLET_STRAIN void differentiate_fourth(const Constants<Fixed> &constants, const Frame<Real> &frame,
                                        const Products<Real> &products, const Strains<Real> &stresses,
                                        Derivatives<Real> &derivatives) {
  constexpr unsigned int k = (j + 1) % 3, l = (j + 2) % 3;
  const Real *T = stresses.bilinear[j];
  const Real &r_j = frame.inverse_squares[j];
  const Real &g_jk = frame.metric[pair[j][k]], &g_jl = frame.metric[pair[j][l]];
  const Real share = constants.fourth * r_j;
  const Real e = share * products.of[3][j], half = Number(0.5) * e;
  const Real more = Number(1.5) * r_j, T_kl = Number(0.5) * T[pair[k][l]];
  const Real u_k = more * (T[k] * g_jk + T_kl * g_jl), u_l = more * (T[l] * g_jl + T_kl * g_jk);
  const Real both = u_k * g_jk + u_l * g_jl;
  Real by_e = T[j] * frame.metric[j] + T[pair[j][k]] * g_jk + T[pair[j][l]] * g_jl + both -
              Number(0.5) * (T[k] * frame.metric[k] + T[l] * frame.metric[l] +
                             T[pair[k][l]] * frame.metric[pair[k][l]]);
  derivatives.metric[j] += e * T[j];
  derivatives.metric[pair[j][k]] += e * (T[pair[j][k]] + (u_k + u_k));
  derivatives.metric[pair[j][l]] += e * (T[pair[j][l]] + (u_l + u_l));
  derivatives.metric[k] -= half * T[k];
  derivatives.metric[l] -= half * T[l];
  derivatives.metric[pair[k][l]] -= half * T[pair[k][l]];
  const Real kept = Number(kept_shear) * frame.inverse_lengths[j];
  by_e +=
      differentiate_shear<Number, j, k>(frame, kept * frame.heights[k], e, stresses.bilinear[k],
                                        derivatives) +
      differentiate_shear<Number, j, l>(frame, kept * frame.heights[l], e, stresses.bilinear[l], derivatives);
  derivatives.length[j] -= Number(2) * (e * (both + by_e));
  derivatives.products[3][j] = share * by_e;
}

/// Adds the derivatives for the bending along k. Call it last, when derivatives.height[k] is
/// complete.
template <class Number, unsigned int k, class Fixed, class Real, class Thinning>
BILLET_STRAIN void differentiate_bending(const Constants<Fixed> &constants, const Frame<Real> &frame,
                                         const Products<Real> &products, const Strains<Real> &stresses,
                                         [[maybe_unused]] const Thinning &thinning,
                                         Derivatives<Real> &derivatives) {
  constexpr unsigned int i = (k + 1) % 3, j = (k + 2) % 3;
  const Bending<Real> h = bend<Number, k>(constants, frame, products);
  const Real *T = stresses.linear[k];
  const Fixed s_i = constants.share[i][k], s_j = constants.share[j][k];
  const Real &p_i = frame.slopes[k][i], &p_j = frame.slopes[k][j];
  const Real &g_ij = frame.metric[pair[i][j]];

  // Thinning, then the in-plane part of a_k
  Real by_sum; // with its sign
  if constexpr (k == 2 && is_free<Thinning>) {
    by_sum = Real{} - thinning.pressure;
    derivatives.height[k] -= Number(2) * (frame.square_heights[k] * T[k] * thinning.strain);
  } else {
    by_sum = constants.thinning[k] * (frame.square_heights[k] * T[k]);
    derivatives.height[k] -= Number(2) * (by_sum * h.sum);
  }
  const Real T_ik = T[pair[i][k]] + p_i * T[k], T_jk = T[pair[j][k]] + p_j * T[k];
  const Real by_p_i = T[k] * h.ik + T_ik * h.ii + T_jk * h.ij,
             by_p_j = T[k] * h.jk + T_ik * h.ij + T_jk * h.jj;
  const Real T_ij = T[pair[i][j]] + p_j * T_ik + p_i * T_jk;
  const Real by_area = frame.inverse_areas[k] * by_sum;
  const Real both = (s_i + s_j) * by_area;
  const Real by_eta_ij = Number(0.5) * (T_ij + both * g_ij);
  const Real half = Number(0.5) * T_ij;
  const Real by_less = half * g_ij;
  derivatives.metric[pair[i][j]] += half * h.less + both * h.eta_ij - Number(2) * (by_area * (h.sum * g_ij));
  derivatives.metric[i] += by_area * (h.sum * frame.metric[j] - h.jj);
  derivatives.metric[j] += by_area * (h.sum * frame.metric[i] - h.ii);

  // Shear that accompanies the bending of each fibre
  const Real by_e_i = (s_i - Number(1)) * by_less +
                      differentiate_shear<Number, i, k>(
                          frame, constants.shear[i][k] * (frame.inverse_lengths[i] * frame.heights[k]), h.e_i,
                          stresses.linear[i], derivatives);
  const Real by_e_j = (s_j - Number(1)) * by_less +
                      differentiate_shear<Number, j, k>(
                          frame, constants.shear[j][k] * (frame.inverse_lengths[j] * frame.heights[k]), h.e_j,
                          stresses.linear[j], derivatives);
  derivatives.length[i] -= Number(2) * (h.e_i * by_e_i);
  derivatives.length[j] -= Number(2) * (h.e_j * by_e_j);
  derivatives.products[j][i] =
      s_i * (T[i] + p_i * T_ik - by_area * frame.metric[j]) + frame.inverse_squares[i] * by_e_i;
  derivatives.products[i][j] =
      s_j * (T[j] + p_j * T_jk - by_area * frame.metric[i]) + frame.inverse_squares[j] * by_e_j;
  derivatives.products[i][i] += by_eta_ij;
  derivatives.products[j][j] += by_eta_ij;

  // Slopes: (a_i, a_j)ᵀ (a_i, a_j) p = (a_i, a_j)ᵀ a_k; heights: 1/height² of a_k is a^k·a^k.
  const Real by_kk = Number(0.5) * (frame.inverse_metric[k] * derivatives.height[k]);
  const Real turned_i = by_kk * p_i, turned_j = by_kk * p_j;
  const Real pi_i = frame.inverse_areas[k] * (frame.metric[j] * by_p_i - g_ij * by_p_j) - turned_i,
             pi_j = frame.inverse_areas[k] * (frame.metric[i] * by_p_j - g_ij * by_p_i) - turned_j;
  derivatives.metric[k] += by_kk;
  derivatives.metric[pair[i][k]] += pi_i - turned_i;
  derivatives.metric[pair[j][k]] += pi_j - turned_j;
  derivatives.metric[i] -= pi_i * p_i;
  derivatives.metric[j] -= pi_j * p_j;
  derivatives.metric[pair[i][j]] -= pi_i * p_j + pi_j * p_i;
}

/// Computes the forces of the power Σ T_ab h_ab˙ of stresses, a ≤ b: shear stresses count twice.
/// They are the derivatives of compute_strains(), and of P times compute_plane_stretch(). Those of
/// the columns are added.
template <class Number, class Fixed, class Real, class Thinning = GivenThinning>
BILLET_STRAIN void compute_forces(const Constants<Fixed> &constants, const Frame<Real> &frame,
                                  const Real (*hourglass)[3], const Products<Real> &products,
                                  const Strains<Real> &stresses, Forces<Real> &forces,
                                  const Thinning &thinning = {}) {
  Derivatives<Real> by;
  for (unsigned int j = 0; j < 3; ++j)
    by.metric[j] = by.metric[3 + j] = by.length[j] = by.height[j] = by.products[j][j] = Real{};
  differentiate_fourth<Number, 0>(constants, frame, products, stresses, by);
  differentiate_fourth<Number, 1>(constants, frame, products, stresses, by);
  differentiate_fourth<Number, 2>(constants, frame, products, stresses, by);
  differentiate_bending<Number, 0>(constants, frame, products, stresses, thinning, by);
  differentiate_bending<Number, 1>(constants, frame, products, stresses, thinning, by);
  differentiate_bending<Number, 2>(constants, frame, products, stresses, thinning, by);
  for (unsigned int k = 0; k < 3; ++k) {
    const unsigned int i = (k + 1) % 3, j = (k + 2) % 3;
    const Real own = (by.metric[k] + by.metric[k]) + frame.inverse_squares[k] * by.length[k];
    for (unsigned int c = 0; c < 3; ++c) {
      forces.columns[k][c] += own * frame.columns[k][c] + by.metric[pair[k][i]] * frame.columns[i][c] +
                              by.metric[pair[k][j]] * frame.columns[j][c];
      for (unsigned int m = 0; m < 4; ++m)
        forces.columns[k][c] += by.products[m][k] * hourglass[m][c];
    }
  }
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int c = 0; c < 3; ++c)
      forces.hourglass[m][c] = by.products[m][0] * frame.columns[0][c] +
                               by.products[m][1] * frame.columns[1][c] +
                               by.products[m][2] * frame.columns[2][c];
}

} // namespace billet::strain_modes

#undef BILLET_STRAIN

#endif
