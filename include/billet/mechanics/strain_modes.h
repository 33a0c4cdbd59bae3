// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_STRAIN_MODES_H
#define BILLET_MECHANICS_STRAIN_MODES_H

// The assumed strains of a brick, (B1) to (B5) of doc/theory.md, and the forces that belong to them: one code
// for the numbers of static scenes, for their derivatives (Dual), and for the lanes of explicit kernels, into
// which all of it is inlined. `Real` is the type of what varies with the displacements, `Fixed` that of
// constants and stresses, `Number` that of literals. Symmetric tensors are 11, 22, 33, 12, 13, 23; of a
// vector per direction of the brick, v[k][i] is component i of that of direction k.

#define BILLET_STRAIN inline __attribute__((always_inline))

namespace billet::strain_modes {

/// θ of (B4), (B5): how much of the parasitic shear is kept. 0 lets modes go free in ideally plastic flow,
/// 1 makes bending in flow up to 2 % stiffer.
constexpr double kept_shear = 0.5;

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
  Real columns[3][3];      ///< a_k
  Real duals[3][3];        ///< a^k
  Real normals[3][3];      ///< a^k/|a^k|
  Real fibres[3][3];       ///< a_k/|a_k|
  Real inverse_squares[3]; ///< 1/|a_k|²
  Real in_plane[3][3][3];  ///< [k][j]: a^j without its part along n_k, j ≠ k
  Real determinant;
};

/// Strains that vary as ξ_k, and as the product of the two other coordinates.
template <class Real> struct Strains { Real linear[3][6], bilinear[3][6]; };

/// Forces of the hourglass vectors, and what the mean velocity gradient L̄ works on: power = Σ hourglass · b̂˙
/// + mean : L̄.
template <class Real> struct Forces {
  Real hourglass[4][3];
  Real mean[3][3]; ///< [row][column]
};

template <class Real, class Other> BILLET_STRAIN auto dot(const Real *a, const Other *b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// S v.
template <class Fixed, class Real> BILLET_STRAIN void multiply(const Fixed *s, const Real *v, Real *result) {
  result[0] = s[0] * v[0] + s[3] * v[1] + s[4] * v[2];
  result[1] = s[3] * v[0] + s[1] * v[1] + s[5] * v[2];
  result[2] = s[4] * v[0] + s[5] * v[1] + s[2] * v[2];
}

/// h += factor sym(a ⊗ b).
template <class Number, class Real>
BILLET_STRAIN void add_symmetric(const Real &factor, const Real *a, const Real *b, Real *h) {
  const Real f[3] = {factor * a[0], factor * a[1], factor * a[2]};
  const Real half[3] = {Number(0.5) * f[0], Number(0.5) * f[1], Number(0.5) * f[2]};
  h[0] += f[0] * b[0];
  h[1] += f[1] * b[1];
  h[2] += f[2] * b[2];
  h[3] += half[0] * b[1] + half[1] * b[0];
  h[4] += half[0] * b[2] + half[2] * b[0];
  h[5] += half[1] * b[2] + half[2] * b[1];
}

/// R += a ⊗ b.
template <class Real> BILLET_STRAIN void add_product(const Real *a, const Real *b, Real (*result)[3]) {
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      result[i][j] += a[i] * b[j];
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
  for (unsigned int k = 0; k < 3; ++k) {
    for (Real &component : frame.duals[k])
      component = inverse * component;
    const Real flat = root(invert(dot(frame.duals[k], frame.duals[k])));
    frame.inverse_squares[k] = invert(dot(a[k], a[k]));
    const Real slender = root(frame.inverse_squares[k]);
    for (unsigned int i = 0; i < 3; ++i) {
      frame.normals[k][i] = flat * frame.duals[k][i];
      frame.fibres[k][i] = slender * a[k][i];
    }
  }
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int j = 0; j < 3; ++j)
      if (j != k) {
        const Real along = dot(frame.duals[j], frame.normals[k]);
        for (unsigned int i = 0; i < 3; ++i)
          frame.in_plane[k][j][i] = frame.duals[j][i] - along * frame.normals[k][i];
      }
}

/// Of the fibres i and j, which bend along k: η of (B2) and e = η_jj/l_j².
template <class Real> struct Bending { Real ii, jj, ij, e_i, e_j; };

template <class Number, class Real>
BILLET_STRAIN Bending<Real> bend(const Frame<Real> &frame, const Real (*hourglass)[3], const unsigned int i,
                                 const unsigned int j) {
  const Real *b_i = hourglass[j], *b_j = hourglass[i]; // with ξ_k goes fibre i's by mode (i, k), of place j
  Bending<Real> eta;
  eta.ii = dot(frame.columns[i], b_i);
  eta.jj = dot(frame.columns[j], b_j);
  eta.ij = Number(0.5) * (dot(frame.columns[i], b_j) + dot(frame.columns[j], b_i));
  eta.e_i = frame.inverse_squares[i] * eta.ii;
  eta.e_j = frame.inverse_squares[j] * eta.jj;
  return eta;
}

/// Of the hourglass vectors b̂_1, b̂_2, b̂_3, ĉ.
template <class Number, class Fixed, class Real>
BILLET_STRAIN void compute_strains(const Constants<Fixed> &constants, const Frame<Real> &frame,
                                   const Real (*hourglass)[3], Strains<Real> &strains) {
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int r = 0; r < 6; ++r)
      strains.linear[k][r] = strains.bilinear[k][r] = Real{};
  for (unsigned int k = 0; k < 3; ++k) {
    const unsigned int i = (k + 1) % 3, j = (k + 2) % 3;
    const Bending<Real> eta = bend<Number>(frame, hourglass, i, j);
    const Real *d_i = frame.in_plane[k][i], *d_j = frame.in_plane[k][j], *n = frame.normals[k];
    const Fixed s_i = constants.share[i][k], s_j = constants.share[j][k];
    // Each fibre's own strain is what is left by its shear: η d ⊗ d − (1 − s) e sym(a ⊗ d) as one product.
    Real v_i[3], v_j[3], w_i[3], w_j[3];
    const Real less_i = (s_i - Number(1)) * eta.e_i, less_j = (s_j - Number(1)) * eta.e_j;
    for (unsigned int m = 0; m < 3; ++m) {
      v_i[m] = eta.ii * d_i[m] + eta.ij * d_j[m];
      v_j[m] = eta.ij * d_i[m] + eta.jj * d_j[m];
      w_i[m] = v_i[m] + less_i * frame.columns[i][m];
      w_j[m] = v_j[m] + less_j * frame.columns[j][m];
    }
    Real *h = strains.linear[k];
    for (unsigned int r = 0; r < 3; ++r)
      h[r] += d_i[r] * w_i[r] + d_j[r] * w_j[r];
    h[3] += Number(0.5) * (d_i[0] * w_i[1] + d_i[1] * w_i[0] + (d_j[0] * w_j[1] + d_j[1] * w_j[0]));
    h[4] += Number(0.5) * (d_i[0] * w_i[2] + d_i[2] * w_i[0] + (d_j[0] * w_j[2] + d_j[2] * w_j[0]));
    h[5] += Number(0.5) * (d_i[1] * w_i[2] + d_i[2] * w_i[1] + (d_j[1] * w_j[2] + d_j[2] * w_j[1]));
    const Real thinning = -constants.thinning[k] * (s_i * dot(d_i, v_i) + s_j * dot(d_j, v_j));
    add_symmetric<Number>(thinning, n, n, h);
    add_symmetric<Number>(constants.shear[i][k] * eta.e_i, frame.fibres[i], n, strains.linear[i]);
    add_symmetric<Number>(constants.shear[j][k] * eta.e_j, frame.fibres[j], n, strains.linear[j]);
  }
  for (unsigned int j = 0; j < 3; ++j) {
    const unsigned int k = (j + 1) % 3, l = (j + 2) % 3;
    const Real *t = frame.fibres[j];
    const Real e = constants.fourth * (frame.inverse_squares[j] * dot(frame.columns[j], hourglass[3]));
    add_symmetric<Number>(Number(1.5) * e, t, t, strains.bilinear[j]);
    for (unsigned int r = 0; r < 3; ++r)
      strains.bilinear[j][r] -= Number(0.5) * e;
    const Real sheared = Number(kept_shear) * e;
    add_symmetric<Number>(sheared, t, frame.normals[k], strains.bilinear[k]);
    add_symmetric<Number>(sheared, t, frame.normals[l], strains.bilinear[l]);
  }
}

/// v without its part along the normal n.
template <class Real> BILLET_STRAIN void project(const Real *n, Real *v) {
  const Real along = dot(n, v);
  for (unsigned int m = 0; m < 3; ++m)
    v[m] -= along * n[m];
}

/// Of the power Σ T : h˙ of stresses T, which are named as the strains are: added to `forces`.
template <class Number, class Fixed, class Real>
BILLET_STRAIN void add_forces(const Constants<Fixed> &constants, const Frame<Real> &frame,
                              const Real (*hourglass)[3], const Strains<Fixed> &stresses,
                              Forces<Real> &forces) {
  Real stretch[3]; // of t_j ⊗ t_j, with their sign
  for (Real &component : stretch)
    component = Real{};
  for (unsigned int k = 0; k < 3; ++k) {
    const unsigned int i = (k + 1) % 3, j = (k + 2) % 3;
    const Bending<Real> eta = bend<Number>(frame, hourglass, i, j);
    const Real *d_i = frame.in_plane[k][i], *d_j = frame.in_plane[k][j], *n = frame.normals[k];
    const Real *a_i = frame.columns[i], *a_j = frame.columns[j];
    const Fixed *T = stresses.linear[k];
    const Fixed s_i = constants.share[i][k], s_j = constants.share[j][k], x = constants.thinning[k];
    Real Td_i[3], Td_j[3], Tn[3];
    multiply(T, d_i, Td_i);
    multiply(T, d_j, Td_j);
    multiply(T, n, Tn);
    const Real thinning = x * dot(n, Tn); // x ν
    const Real g_ii = dot(d_i, d_i), g_jj = dot(d_j, d_j), g_ij = dot(d_i, d_j);

    // The shear that goes with each fibre's bending.
    Real rho[2], Tn_of[2][3], Tt_of[2][3];
    for (unsigned int m = 0; m < 2; ++m) {
      const unsigned int f = m == 0 ? i : j;
      multiply(stresses.linear[f], n, Tn_of[m]);
      multiply(stresses.linear[f], frame.fibres[f], Tt_of[m]);
      rho[m] = dot(frame.fibres[f], Tn_of[m]);
    }
    const Real q_i = (s_i - Number(1)) * dot(a_i, Td_i) + constants.shear[i][k] * rho[0],
               q_j = (s_j - Number(1)) * dot(a_j, Td_j) + constants.shear[j][k] * rho[1];

    // ∂/∂η, and with it the hourglass vectors and the columns in η
    const Fixed both = Number(0.5) * (s_i + s_j);
    const Real u_ii = dot(d_i, Td_i) - s_i * (thinning * g_ii) + frame.inverse_squares[i] * q_i,
               u_jj = dot(d_j, Td_j) - s_j * (thinning * g_jj) + frame.inverse_squares[j] * q_j,
               u_ij = dot(d_i, Td_j) - both * (thinning * g_ij);
    Real f_i[3], f_j[3];
    for (unsigned int m = 0; m < 3; ++m) {
      f_i[m] = u_ii * a_i[m] + u_ij * a_j[m];
      f_j[m] = u_ij * a_i[m] + u_jj * a_j[m];
      forces.hourglass[j][m] += f_i[m];
      forces.hourglass[i][m] += f_j[m];
    }
    add_product(hourglass[j], f_i, forces.mean);
    add_product(hourglass[i], f_j, forces.mean);

    // ∂/∂ the directions in the plane, its normal and the fibres: by L̄
    const Real less_i = (s_i - Number(1)) * eta.e_i, less_j = (s_j - Number(1)) * eta.e_j;
    Real sum = s_i * (eta.ii * g_ii) + s_j * (eta.jj * g_jj) +
               (both + both) * (eta.ij * g_ij); // what the thinning follows
    Real Ta_i[3], Ta_j[3], p_i[3], p_j[3], along_i, along_j;
    multiply(T, a_i, Ta_i);
    multiply(T, a_j, Ta_j);
    for (unsigned int m = 0; m < 3; ++m) {
      p_i[m] = Number(2) * (eta.ii * Td_i[m] + eta.ij * Td_j[m]) + less_i * Ta_i[m];
      p_j[m] = Number(2) * (eta.ij * Td_i[m] + eta.jj * Td_j[m]) + less_j * Ta_j[m];
    }
    along_i = dot(n, p_i);
    along_j = dot(n, p_j);
    const Real twice = thinning + thinning;
    Real of_normal[3]; // n ⊗ ...
    Real PTn[3] = {Tn[0], Tn[1], Tn[2]};
    project(n, PTn);
    const Real twice_sum = (x + x) * sum;
    const Real shear_i = constants.shear[i][k] * eta.e_i, shear_j = constants.shear[j][k] * eta.e_j;
    Real Tt_i[3] = {Tt_of[0][0], Tt_of[0][1], Tt_of[0][2]}, Tt_j[3] = {Tt_of[1][0], Tt_of[1][1], Tt_of[1][2]};
    project(n, Tt_i);
    project(n, Tt_j);
    Real from_i[3], from_j[3], to_i[3], to_j[3];
    for (unsigned int m = 0; m < 3; ++m) {
      const Real out_i = along_i * n[m] - p_i[m], out_j = along_j * n[m] - p_j[m];
      from_i[m] = out_i + twice * (s_i * (eta.ii * d_i[m]) + both * (eta.ij * d_j[m]));
      from_j[m] = out_j + twice * (both * (eta.ij * d_i[m]) + s_j * (eta.jj * d_j[m]));
      of_normal[m] =
          along_i * d_i[m] + along_j * d_j[m] + twice_sum * PTn[m] - shear_i * Tt_i[m] - shear_j * Tt_j[m];
      to_i[m] = less_i * Td_i[m];
      to_j[m] = less_j * Td_j[m];
    }
    add_product(d_i, from_i, forces.mean);
    add_product(d_j, from_j, forces.mean);
    add_product(n, of_normal, forces.mean);
    add_product(to_i, a_i, forces.mean);
    add_product(to_j, a_j, forces.mean);
    for (unsigned int m = 0; m < 3; ++m) {
      to_i[m] = shear_i * Tn_of[0][m];
      to_j[m] = shear_j * Tn_of[1][m];
    }
    add_product(to_i, frame.fibres[i], forces.mean);
    add_product(to_j, frame.fibres[j], forces.mean);
    stretch[i] -= Number(2) * (eta.e_i * q_i) + shear_i * rho[0];
    stretch[j] -= Number(2) * (eta.e_j * q_j) + shear_j * rho[1];
  }

  for (unsigned int j = 0; j < 3; ++j) {
    const unsigned int others[2] = {(j + 1) % 3, (j + 2) % 3};
    const Real *t = frame.fibres[j];
    const Fixed *B = stresses.bilinear[j];
    const Real e = constants.fourth * (frame.inverse_squares[j] * dot(frame.columns[j], hourglass[3]));
    const Real sheared = Number(kept_shear) * e;
    Real Bt[3], to[3];
    multiply(B, t, Bt);
    const Real tBt = dot(t, Bt);
    Real kappa = Number(1.5) * tBt;
    kappa -= Number(0.5) * (B[0] + B[1] + B[2]);
    for (unsigned int m = 0; m < 3; ++m)
      to[m] = Number(3) * (e * Bt[m]);
    Real pulled = Number(3) * (e * tBt);
    for (const unsigned int k : others) {
      const Real *n = frame.normals[k];
      Real Bn[3], PBt[3];
      multiply(stresses.bilinear[k], n, Bn);
      multiply(stresses.bilinear[k], t, PBt);
      const Real rho = dot(t, Bn);
      kappa += Number(kept_shear) * rho;
      pulled += sheared * rho;
      project(n, PBt);
      for (unsigned int m = 0; m < 3; ++m) {
        to[m] += sheared * Bn[m];
        PBt[m] = (Real{} - sheared) * PBt[m];
      }
      add_product(n, PBt, forces.mean);
    }
    add_product(to, t, forces.mean);
    stretch[j] -= pulled + Number(2) * (e * kappa);
    const Real by_hourglass = constants.fourth * (frame.inverse_squares[j] * kappa);
    Real f[3];
    for (unsigned int m = 0; m < 3; ++m) {
      f[m] = by_hourglass * frame.columns[j][m];
      forces.hourglass[3][m] += f[m];
    }
    add_product(hourglass[3], f, forces.mean);
  }
  for (unsigned int j = 0; j < 3; ++j) {
    Real scaled[3];
    for (unsigned int m = 0; m < 3; ++m)
      scaled[m] = stretch[j] * frame.fibres[j][m];
    add_product(scaled, frame.fibres[j], forces.mean);
  }
}

} // namespace billet::strain_modes

#undef BILLET_STRAIN

#endif
