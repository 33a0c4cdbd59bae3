// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_STRAIN_MODES_H
#define BILLET_MECHANICS_STRAIN_MODES_H

// The assumed strains of a brick, (B1) to (B5) of doc/theory.md, and the forces that belong to them: one code
// for the numbers of static scenes, for their derivatives (Dual), and for the lanes of explicit kernels, into
// which all of it is inlined. `Real` is the type of what varies with the displacements, `Fixed` that of
// constants, `Number` that of literals. Symmetric tensors are 11, 22, 33, 12, 13, 23; of a vector per
// direction of the brick, v[k][i] is component i of that of direction k.
//
// Strains are written by their products with the columns, h_ab = a_a·h a_b (B8). There most vectors of (B3)
// to (B5) have one component or two, and nothing but scalars is left: of the metric a_a·a_b and of a_a·b̂.

#define BILLET_STRAIN inline __attribute__((always_inline))

namespace billet::strain_modes {

/// θ of (B4), (B5): how much of the parasitic shear is kept. 0 lets modes go free in ideally plastic flow,
/// 1 makes bending in flow up to 2 % stiffer.
constexpr double kept_shear = 0.5;

/// Where a pair of directions stands.
constexpr unsigned int pair[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
constexpr unsigned int first_of[6] = {0, 1, 2, 0, 0, 1}, second_of[6] = {0, 1, 2, 1, 2, 2};

/// Share s of a fibre j's bending that it has itself, the rest is the shear's which goes with it, and that
/// shear per bending, s θ_jk; of the edges' lengths l_j/l_k in the undeformed brick, (B4).
/// Then the thinning x_k of (B3), and the share of the fourth mode. All from the elastic moduli.
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
  Real heights[3];        ///< of a_k over the plane of the others
  Real inverse_areas[3];  ///< 1/|a_i × a_j|²
  Real slopes[3][3];      ///< [k][j], j ≠ k: how much of a_j is in the part of a_k in the plane, d^j·a_k
};

/// Strains that vary as ξ_k, and as the product of the two other coordinates.
template <class Real> struct Strains { Real linear[3][6], bilinear[3][6]; };

/// a_k·b̂_1, b̂_2, b̂_3, ĉ: [vector][k].
template <class Real> struct Products { Real of[4][3]; };

/// Forces of the hourglass vectors, and of the columns where strains follow those by their metric and by
/// their products with the hourglass vectors.
template <class Real> struct Forces { Real hourglass[4][3], columns[3][3]; };

template <class Real, class Other> BILLET_STRAIN auto dot(const Real *a, const Other *b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// `columns` are set; `invert` and `root` are 1/x and √x.
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

/// What bends along k, of the fibres i and j: η of (B2) and e = η_jj/l_j², and what (B3) makes of them but
/// for the thinning.
template <class Real> struct Bending {
  Real eta_ii, eta_jj, eta_ij, e_i, e_j;
  Real less;               ///< Σ (1 − s) e of both, with its sign
  Real ii, jj, ij, ik, jk; ///< h_k; a_k has the strain of its part in the plane
  Real sum;                ///< what the thinning follows
};

template <class Number, class Fixed, class Real>
BILLET_STRAIN Bending<Real> bend(const Constants<Fixed> &constants, const Frame<Real> &frame,
                                 const Products<Real> &products, const unsigned int k) {
  const unsigned int i = (k + 1) % 3, j = (k + 2) % 3;
  const Fixed s_i = constants.share[i][k], s_j = constants.share[j][k];
  const Real &g_ij = frame.metric[pair[i][j]], &p_i = frame.slopes[k][i], &p_j = frame.slopes[k][j];
  Bending<Real> h;
  h.eta_ii = products.of[j][i]; // with ξ_k goes fibre i's by mode (i, k), of place j
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

/// h += factor sym(a_j ⊗ a^k), l the third direction.
template <class Number, class Real>
BILLET_STRAIN void add_shear(const Frame<Real> &frame, const Real &factor, const unsigned int j,
                             const unsigned int k, Real *h) {
  const unsigned int l = 3 - j - k;
  const Real half = Number(0.5) * factor;
  h[k] += factor * frame.metric[pair[j][k]];
  h[pair[j][k]] += half * frame.metric[j];
  h[pair[k][l]] += half * frame.metric[pair[j][l]];
}

/// (B3) to (B5).
template <class Number, class Fixed, class Real>
BILLET_STRAIN void compute_strains(const Constants<Fixed> &constants, const Frame<Real> &frame,
                                   const Products<Real> &products, Strains<Real> &strains) {
  Real e[3][3]; // [j][k]
  for (unsigned int k = 0; k < 3; ++k) {
    const unsigned int i = (k + 1) % 3, j = (k + 2) % 3;
    const Bending<Real> bending = bend<Number>(constants, frame, products, k);
    e[i][k] = bending.e_i;
    e[j][k] = bending.e_j;
    Real *h = strains.linear[k];
    h[i] = bending.ii;
    h[j] = bending.jj;
    h[pair[i][j]] = bending.ij;
    h[pair[i][k]] = bending.ik;
    h[pair[j][k]] = bending.jk;
    h[k] = frame.slopes[k][i] * bending.ik + frame.slopes[k][j] * bending.jk -
           constants.thinning[k] * (frame.square_heights[k] * bending.sum);
  }
  for (unsigned int j = 0; j < 3; ++j) {
    const unsigned int k = (j + 1) % 3, l = (j + 2) % 3;
    const Real fourth = constants.fourth * (frame.inverse_squares[j] * products.of[3][j]);
    const Real half = Number(0.5) * fourth, more = (Number(1.5) * fourth) * frame.inverse_squares[j];
    const Real &g_jk = frame.metric[pair[j][k]], &g_jl = frame.metric[pair[j][l]];
    const Real more_k = more * g_jk;
    Real *h = strains.bilinear[j];
    h[j] = fourth * frame.metric[j];
    h[pair[j][k]] = fourth * g_jk;
    h[pair[j][l]] = fourth * g_jl;
    h[k] = more_k * g_jk - half * frame.metric[k];
    h[l] = more * (g_jl * g_jl) - half * frame.metric[l];
    h[pair[k][l]] = more_k * g_jl - half * frame.metric[pair[k][l]];
    e[j][j] = Number(kept_shear) * fourth;
  }
  for (unsigned int j = 0; j < 3; ++j)
    for (unsigned int k = 0; k < 3; ++k)
      if (j != k) {
        const Real slender = frame.inverse_lengths[j] * frame.heights[k]; // t_j ⊗ n_k = a_j ⊗ a^k times it
        add_shear<Number>(frame, constants.shear[j][k] * (e[j][k] * slender), j, k, strains.linear[j]);
        add_shear<Number>(frame, e[j][j] * slender, j, k, strains.bilinear[k]);
      }
}

/// Of a strain `factor` sym(a_j ⊗ a^k) and its stress T: T times it per factor, and what it does to the
/// metric.
template <class Number, class Real>
BILLET_STRAIN Real work_of_shear(const Frame<Real> &frame, const Real *T, const unsigned int j,
                                 const unsigned int k) {
  const unsigned int l = 3 - j - k;
  return T[k] * frame.metric[pair[j][k]] +
         Number(0.5) * (T[pair[j][k]] * frame.metric[j] + T[pair[k][l]] * frame.metric[pair[j][l]]);
}
template <class Number, class Real>
BILLET_STRAIN void add_forces_of_shear(const Real &factor, const Real *T, const unsigned int j,
                                       const unsigned int k, Real *of_metric) {
  const unsigned int l = 3 - j - k;
  const Real half = Number(0.5) * factor;
  of_metric[pair[j][k]] += factor * T[k];
  of_metric[j] += half * T[pair[j][k]];
  of_metric[pair[j][l]] += half * T[pair[k][l]];
}

/// Of the power Σ T_ab h_ab˙ of stresses, a ≤ b: the shear stresses count twice. Added to `forces`. The
/// derivatives of the code above, backwards: by the metric, by ln l_j, by ln(height_k), and by the products.
template <class Number, class Fixed, class Real>
BILLET_STRAIN void add_forces(const Constants<Fixed> &constants, const Frame<Real> &frame,
                              const Real (*hourglass)[3], const Products<Real> &products,
                              const Strains<Real> &stresses, Forces<Real> &forces) {
  Real of_metric[6], of_length[3], of_height[3], of_products[4][3];
  for (unsigned int j = 0; j < 3; ++j) {
    of_metric[j] = of_metric[3 + j] = of_height[j] = Real{};
    of_products[j][j] = Real{};
  }
  for (unsigned int j = 0; j < 3; ++j) {
    const unsigned int k = (j + 1) % 3, l = (j + 2) % 3;
    const Real *T = stresses.bilinear[j];
    const Real &r_j = frame.inverse_squares[j];
    const Real &g_jk = frame.metric[pair[j][k]], &g_jl = frame.metric[pair[j][l]];
    const Real e = constants.fourth * (r_j * products.of[3][j]), half = Number(0.5) * e;
    const Real more = Number(1.5) * r_j, T_kl = Number(0.5) * T[pair[k][l]];
    const Real u_k = more * (T[k] * g_jk + T_kl * g_jl), u_l = more * (T[l] * g_jl + T_kl * g_jk);
    const Real both = u_k * g_jk + u_l * g_jl;
    Real of_e = T[j] * frame.metric[j] + T[pair[j][k]] * g_jk + T[pair[j][l]] * g_jl + both -
                Number(0.5) * (T[k] * frame.metric[k] + T[l] * frame.metric[l] +
                               T[pair[k][l]] * frame.metric[pair[k][l]]);
    of_metric[j] += e * T[j];
    of_metric[pair[j][k]] += e * (T[pair[j][k]] + (u_k + u_k));
    of_metric[pair[j][l]] += e * (T[pair[j][l]] + (u_l + u_l));
    of_metric[k] -= half * T[k];
    of_metric[l] -= half * T[l];
    of_metric[pair[k][l]] -= half * T[pair[k][l]];
    Real sheared = Real{};
    for (unsigned int other = 0; other < 2; ++other) {
      const unsigned int m = other == 0 ? k : l;
      const Real work = work_of_shear<Number>(frame, stresses.bilinear[m], j, m);
      const Real factor = Number(kept_shear) * (frame.inverse_lengths[j] * frame.heights[m]);
      const Real force = factor * e, ratio = force * work;
      of_e += factor * work;
      of_height[m] += ratio;
      sheared += ratio;
      add_forces_of_shear<Number>(force, stresses.bilinear[m], j, m, of_metric);
    }
    of_length[j] = Real{} - sheared - Number(2) * (e * (both + of_e));
    of_products[3][j] = constants.fourth * (r_j * of_e);
  }
  for (unsigned int k = 0; k < 3; ++k) {
    const unsigned int i = (k + 1) % 3, j = (k + 2) % 3;
    const Bending<Real> h = bend<Number>(constants, frame, products, k);
    const Real *T = stresses.linear[k];
    const Fixed s_i = constants.share[i][k], s_j = constants.share[j][k];
    const Real &p_i = frame.slopes[k][i], &p_j = frame.slopes[k][j];
    const Real &g_ij = frame.metric[pair[i][j]];

    // The thinning, then from a_k to its part in the plane
    const Real of_sum = Real{} - constants.thinning[k] * (frame.square_heights[k] * T[k]);
    of_height[k] += Number(2) * (of_sum * h.sum);
    const Real T_ik = T[pair[i][k]] + p_i * T[k], T_jk = T[pair[j][k]] + p_j * T[k];
    const Real of_p_i = T[k] * h.ik + T_ik * h.ii + T_jk * h.ij,
               of_p_j = T[k] * h.jk + T_ik * h.ij + T_jk * h.jj;
    const Real T_ij = T[pair[i][j]] + p_j * T_ik + p_i * T_jk;
    const Real by_area = frame.inverse_areas[k] * of_sum;
    const Real of_eta_ij = T_ij - (s_i + s_j) * (by_area * g_ij);
    const Real half = Number(0.5) * T_ij;
    const Real of_less = half * g_ij;
    of_metric[pair[i][j]] += half * h.less - by_area * ((s_i + s_j) * h.eta_ij - Number(2) * (h.sum * g_ij));
    of_metric[i] += by_area * (h.jj - h.sum * frame.metric[j]);
    of_metric[j] += by_area * (h.ii - h.sum * frame.metric[i]);

    // The shear that goes with each fibre's bending
    Real of_e[2];
    for (unsigned int m = 0; m < 2; ++m) {
      const unsigned int f = m == 0 ? i : j;
      const Real &e = m == 0 ? h.e_i : h.e_j;
      const Real work = work_of_shear<Number>(frame, stresses.linear[f], f, k);
      const Real factor = constants.shear[f][k] * (frame.inverse_lengths[f] * frame.heights[k]);
      const Real force = factor * e, ratio = force * work;
      of_e[m] = (constants.share[f][k] - Number(1)) * of_less + factor * work;
      of_height[k] += ratio;
      of_length[f] -= ratio + Number(2) * (e * of_e[m]);
      add_forces_of_shear<Number>(force, stresses.linear[f], f, k, of_metric);
    }
    of_products[j][i] =
        s_i * (T[i] + p_i * T_ik + by_area * frame.metric[j]) + frame.inverse_squares[i] * of_e[0];
    of_products[i][j] =
        s_j * (T[j] + p_j * T_jk + by_area * frame.metric[i]) + frame.inverse_squares[j] * of_e[1];
    of_products[i][i] += Number(0.5) * of_eta_ij;
    of_products[j][j] += Number(0.5) * of_eta_ij;

    // Slopes: (a_i, a_j)ᵀ (a_i, a_j) p = (a_i, a_j)ᵀ a_k; heights: 1/height² of a_k is a^k·a^k.
    const Real of_kk = Number(0.5) * (frame.inverse_metric[k] * of_height[k]);
    const Real turned_i = of_kk * p_i, turned_j = of_kk * p_j;
    const Real pi_i = frame.inverse_areas[k] * (frame.metric[j] * of_p_i - g_ij * of_p_j) - turned_i,
               pi_j = frame.inverse_areas[k] * (frame.metric[i] * of_p_j - g_ij * of_p_i) - turned_j;
    of_metric[k] += of_kk;
    of_metric[pair[i][k]] += pi_i - turned_i;
    of_metric[pair[j][k]] += pi_j - turned_j;
    of_metric[i] -= pi_i * p_i;
    of_metric[j] -= pi_j * p_j;
    of_metric[pair[i][j]] -= pi_i * p_j + pi_j * p_i;
  }

  for (unsigned int k = 0; k < 3; ++k) {
    const unsigned int i = (k + 1) % 3, j = (k + 2) % 3;
    const Real own = (of_metric[k] + of_metric[k]) + frame.inverse_squares[k] * of_length[k];
    for (unsigned int c = 0; c < 3; ++c) {
      forces.columns[k][c] += own * frame.columns[k][c] + of_metric[pair[k][i]] * frame.columns[i][c] +
                              of_metric[pair[k][j]] * frame.columns[j][c];
      for (unsigned int m = 0; m < 4; ++m)
        forces.columns[k][c] += of_products[m][k] * hourglass[m][c];
    }
  }
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int c = 0; c < 3; ++c)
      forces.hourglass[m][c] += of_products[m][0] * frame.columns[0][c] +
                                of_products[m][1] * frame.columns[1][c] +
                                of_products[m][2] * frame.columns[2][c];
}

} // namespace billet::strain_modes

#undef BILLET_STRAIN

#endif
