// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_HOURGLASS_ENERGY_H
#define BILLET_MECHANICS_HOURGLASS_ENERGY_H

// Energy of the hourglass strains of a one-point brick, (X6) of doc/theory.md, and the conjugate
// stresses. Implicit scenes and the lanes of explicit kernels share this code, which is inlined.
// `Real` is the type of element data, `Number` that of constants. The strains are those of
// strain_modes.h without any shear. The metric of the plane that they are in knows its normal.

#define BILLET_HOURGLASS inline __attribute__((always_inline))

namespace billet::hourglass {

/// Moduli of plane stress, with the energy ½ bending (tr e)² − plane det e for strains e in a
/// plane, and of the fourth mode.
template <class Number> struct Moduli {
  Number bending, plane, fourth; ///< 2G/(3(1 − ν)), 2G/3, E/9

  BILLET_HOURGLASS Moduli(const Number bulk, const Number shear) {
    const Number young = 9 * bulk * shear / (3 * bulk + shear),
                 poisson = (3 * bulk - 2 * shear) / (6 * bulk + 2 * shear);
    plane = 2 * shear / 3;
    bending = plane / (1 - poisson);
    fourth = young / 9;
  }
};

/// Products of the undeformed brick's columns a_1, a_2, a_3, in any unit.
template <class Real> struct Metric {
  Real square[3], inverse_square[3]; ///< [k]: |a_k|²
  Real product[3];                   ///< [k]: a_i · a_j
  Real inverse_area[3];              ///< [k]: 1/|a_i × a_j|²

  /// Completes the metric, whose squares and products are set; `invert` is 1/x.
  template <class Invert> BILLET_HOURGLASS void complete(const Invert &invert) {
    for (unsigned int k = 0; k < 3; ++k) {
      inverse_square[k] = invert(square[k]);
      inverse_area[k] = invert(square[(k + 1) % 3] * square[(k + 2) % 3] - product[k] * product[k]);
    }
  }

  /// Returns a_l · Σ_n a_n v_n.
  BILLET_HOURGLASS Real lower(const unsigned int l, const Real *v) const {
    const unsigned int i = (l + 1) % 3, j = (l + 2) % 3;
    return square[l] * v[l] + product[j] * v[i] + product[i] * v[j];
  }
};

/// Computes the stresses s = ∂W/∂h, per volume, for the strains h of b_1, b_2, b_3, c in the
/// element's own directions. Returns W.
template <class Number, class Real>
BILLET_HOURGLASS Real respond(const Moduli<Number> &moduli, const Metric<Real> &metric, const Real (*h)[3],
                              Real (*s)[3]) {
  Real products[3][3], by_products[3][3]; // a_l · b̂_m, and derivatives by them
  for (unsigned int l = 0; l < 3; ++l) {
    for (unsigned int m = 0; m < 3; ++m)
      products[l][m] = metric.lower(l, h[m]);
    by_products[l][l] = Real{};
  }
  Real energy{};
  for (unsigned int k = 0; k < 3; ++k) {
    // Strains that vary along k: fibre i bends by mode (i, k), at position j.
    const unsigned int i = (k + 1) % 3, j = (k + 2) % 3;
    const Real p = products[i][j], q = products[j][i], r = Number(0.5) * (products[i][i] + products[j][j]);
    const Real inverse = metric.inverse_area[k], angle = metric.product[k];
    const Real trace = inverse * (metric.square[j] * p + metric.square[i] * q - Number(2) * (angle * r));
    const Real stress = moduli.bending * trace, sigma = inverse * stress, mu = moduli.plane * inverse;
    energy += Number(0.5) * (stress * trace) - mu * (p * q - r * r);
    by_products[i][j] = sigma * metric.square[j] - mu * q;
    by_products[j][i] = sigma * metric.square[i] - mu * p;
    const Real twist = mu * r - sigma * angle;
    by_products[i][i] += twist;
    by_products[j][j] += twist;
  }
  Real fourth[3];
  for (unsigned int l = 0; l < 3; ++l) {
    const Real strain = metric.inverse_square[l] * metric.lower(l, h[3]);
    const Real stress = moduli.fourth * strain;
    energy += Number(0.5) * (stress * strain);
    fourth[l] = metric.inverse_square[l] * stress;
  }
  for (unsigned int n = 0; n < 3; ++n) {
    for (unsigned int m = 0; m < 3; ++m) {
      const Real column[3] = {by_products[0][m], by_products[1][m], by_products[2][m]};
      s[m][n] = metric.lower(n, column);
    }
    s[3][n] = metric.lower(n, fourth);
  }
  return energy;
}

} // namespace billet::hourglass

#undef BILLET_HOURGLASS

#endif
