// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/assumed_strain_element.h"

#include "billet/mechanics/dual_number.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;
using strain_modes::Forces;
using strain_modes::Frame;
using strain_modes::Products;
using strain_modes::Strains;

namespace {

constexpr unsigned int n_directions = 9; ///< components of the columns a_k
constexpr unsigned int n_vectors = AssumedStrainElement<>::n_vectors;
constexpr unsigned int n_unknowns = 3 * n_vectors; ///< columns and hourglass vectors
/// Bricks with layers have X as one more unknown, the last.
constexpr unsigned int thinning = n_unknowns;
constexpr unsigned int thinning_direction = n_directions;
// Rows are padded to a multiple of the SIMD width.
constexpr unsigned int width = 24, direction_width = 10;
constexpr unsigned int n_tensors = 6; ///< strains: three linear, three bilinear
using Direction = Dual<double, direction_width>;
/// One number for each unknown.
using Row = std::array<double, width>;
template <std::size_t n> using Rows = std::array<Row, n>;

constexpr unsigned int symmetric[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
constexpr unsigned int pair_of[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

double poisson_ratio(const ElasticModuli &elastic) {
  return (3. * elastic.bulk - 2. * elastic.shear) / (6. * elastic.bulk + 2. * elastic.shear);
}

double reciprocal(const double x) { return 1. / x; }
double root(const double x) { return std::sqrt(x); }

/// Factors of each strain at each point.
template <unsigned int n_through> using Shares = std::array<std::array<double, n_tensors>, 4 * n_through>;
template <unsigned int n_through> Shares<n_through> compute_shares() {
  Shares<n_through> shares{};
  const double place = 1. / std::sqrt(3.);
  for (unsigned int q = 0; q < shares.size(); ++q) {
    const std::array<double, 3> at = {place * corner(q, 0), place * corner(q, 1),
                                      gauss_rule(n_through).points[q / 4]};
    for (unsigned int k = 0; k < 3; ++k) {
      shares[q][k] = at[k];
      shares[q][3 + k] = at[(k + 1) % 3] * at[(k + 2) % 3];
    }
  }
  return shares;
}
template <unsigned int n_through> const Shares<n_through> shares = compute_shares<n_through>();

/// Returns the part of the volume that belongs to a point.
template <unsigned int n_through> double point_weight(const double volume, const unsigned int q) {
  if constexpr (n_through == 2)
    return volume / n_element_points;
  static const std::array<double, n_through> weights = [] {
    std::array<double, n_through> made{};
    for (unsigned int l = 0; l < n_through; ++l)
      made[l] = 0.25 * gauss_rule(n_through).weights[l];
    return made;
  }();
  return volume * weights[q / 4];
}

template <class Real> Real *tensor(Strains<Real> &strains, const unsigned int t) {
  return t < 3 ? strains.linear[t] : strains.bilinear[t - 3];
}
template <class Real> const Real *tensor(const Strains<Real> &strains, const unsigned int t) {
  return t < 3 ? strains.linear[t] : strains.bilinear[t - 3];
}

/// Computes S v.
template <class Fixed, class Real> void multiply(const Fixed *s, const Real *v, Real *result) {
  for (unsigned int i = 0; i < 3; ++i)
    result[i] = s[symmetric[i][0]] * v[0] + s[symmetric[i][1]] * v[1] + s[symmetric[i][2]] * v[2];
}

/// Computes the spatial strains, Σ h_ab a^a ⊗ a^b.
template <class Real, class Thinning>
void compute_spatial_strains(const strain_modes::Constants<double> &constants, const Frame<Real> &frame,
                             const Real (*hourglass)[3], const Thinning &of_layers, Strains<Real> &strains) {
  Products<Real> products;
  strain_modes::multiply(frame, hourglass, products);
  Strains<Real> by_columns;
  strain_modes::compute_strains<double>(constants, frame, products, by_columns, of_layers);
  for (unsigned int t = 0; t < n_tensors; ++t) {
    const Real *h = tensor(by_columns, t);
    Real half[3][3]; // [a][i]: Σ_b h_ab a^b
    for (unsigned int i = 0; i < 3; ++i) {
      const Real component[3] = {frame.duals[0][i], frame.duals[1][i], frame.duals[2][i]};
      Real of_all[3];
      multiply(h, component, of_all);
      for (unsigned int a = 0; a < 3; ++a)
        half[a][i] = of_all[a];
    }
    for (unsigned int r = 0; r < 6; ++r) {
      const unsigned int i = pair_of[r][0], j = pair_of[r][1];
      tensor(strains, t)[r] =
          frame.duals[0][i] * half[0][j] + frame.duals[1][i] * half[1][j] + frame.duals[2][i] * half[2][j];
    }
  }
}

/// Returns the thinning and its force as numbers of type `Real`; GivenThinning without layers.
template <class Real, unsigned int n_through>
auto thinning_of(const typename AssumedStrainElement<n_through>::Reference &reference,
                 const typename AssumedStrainElement<n_through>::Kinematics &kinematics) {
  if constexpr (n_through == 2)
    return strain_modes::GivenThinning();
  else {
    strain_modes::FreeThinning<Real> of_layers{
        kinematics.thinning, AssumedStrainElement<n_through>::thinning_force(reference, kinematics)};
    if constexpr (std::is_same_v<Real, Direction>)
      of_layers.strain.rate[thinning_direction] = 1.;
    return of_layers;
  }
}

/// Returns zero thinning.
template <class Real, unsigned int n_through> auto no_thinning() {
  if constexpr (n_through == 2)
    return strain_modes::GivenThinning();
  else
    return strain_modes::FreeThinning<Real>{Real{}, Real{}};
}

/// Sums over the points, with volumes w: w (p 1 + Y dev τ Y⁻¹), conjugate to the mean gradient, and
/// w sym(dev τ Y⁻¹) for each strain.
struct StressSums {
  Tensor<2, 3> mean;
  Strains<double> of_strains{};
};

template <unsigned int n_through>
StressSums sum_stresses(const typename AssumedStrainElement<n_through>::Reference &reference,
                        const typename AssumedStrainElement<n_through>::Kinematics &kinematics,
                        const typename AssumedStrainElement<n_through>::Stresses &tau) {
  StressSums sums;
  for (unsigned int q = 0; q < tau.size(); ++q) {
    const double weight = point_weight<n_through>(reference.volume, q);
    const Tensor<2, 3> dev = dealii::deviator(tau[q]);
    const Tensor<2, 3> by_inverse = dev * Tensor<2, 3>(kinematics.inverse_Y[q]);
    sums.mean += weight * (Tensor<2, 3>(kinematics.Y[q]) * by_inverse);
    for (unsigned int i = 0; i < 3; ++i)
      sums.mean[i][i] += weight * dealii::trace(tau[q]) / 3.;
    for (unsigned int r = 0; r < 6; ++r) {
      const unsigned int i = pair_of[r][0], j = pair_of[r][1];
      const double T = 0.5 * weight * (by_inverse[i][j] + by_inverse[j][i]);
      for (unsigned int t = 0; t < n_tensors; ++t)
        tensor(sums.of_strains, t)[r] += shares<n_through>[q][t] * T;
    }
  }
  return sums;
}

/// Returns the forces of the seven vectors.
template <class Real, class Thinning>
std::array<std::array<Real, 3>, n_vectors>
compute_vector_forces(const strain_modes::Constants<double> &constants, const Frame<Real> &frame,
                      const Real (*hourglass)[3], const Thinning &of_layers, const StressSums &sums) {
  Forces<Real> forces{};
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        forces.columns[k][i] += sums.mean[i][j] * frame.duals[k][j];
  Products<Real> products;
  strain_modes::multiply(frame, hourglass, products);
  Strains<Real> strains, stresses;
  strain_modes::compute_strains<double>(constants, frame, products, strains, of_layers);
  // In T : (δh_ab a^a ⊗ a^b) the duals depend on the columns: δa^a = −Σ_k (a^a·δa_k) a^k.
  Real of_duals[3][3] = {}; // [a][k]
  for (unsigned int t = 0; t < n_tensors; ++t) {
    const double *T = tensor(sums.of_strains, t);
    const Real *h = tensor(strains, t);
    Real by_duals[3][3], products_of_T[6];
    for (unsigned int a = 0; a < 3; ++a)
      multiply(T, frame.duals[a], by_duals[a]);
    for (unsigned int r = 0; r < 6; ++r) {
      products_of_T[r] = strain_modes::dot(frame.duals[pair_of[r][0]], by_duals[pair_of[r][1]]);
      tensor(stresses, t)[r] = (r < 3 ? 1. : 2.) * products_of_T[r];
    }
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int b = 0; b < 3; ++b)
          of_duals[a][k] += h[symmetric[a][b]] * products_of_T[symmetric[b][k]];
  }
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int a = 0; a < 3; ++a)
        forces.columns[k][i] -= 2. * (of_duals[a][k] * frame.duals[a][i]);
  strain_modes::compute_forces<double>(constants, frame, hourglass, products, stresses, forces, of_layers);
  std::array<std::array<Real, 3>, n_vectors> result;
  for (unsigned int i = 0; i < 3; ++i) {
    for (unsigned int k = 0; k < 3; ++k)
      result[k][i] = forces.columns[k][i];
    for (unsigned int m = 0; m < 4; ++m)
      result[3 + m][i] = forces.hourglass[m][i];
  }
  return result;
}

/// Returns the frame with its derivatives by the columns' components, 3 k + i.
Frame<Direction> differentiate(const Frame<double> &frame) {
  Frame<Direction> result;
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i) {
      result.columns[k][i] = frame.columns[k][i];
      result.columns[k][i].rate[3 * k + i] = 1.;
    }
  strain_modes::complete(
      result, [](const Direction &x) { return billet::invert(x); },
      [](const Direction &x) { return square_root(x, root); });
  return result;
}

/// Returns the derivatives of the strains by the unknowns.
template <unsigned int n_through>
std::array<Rows<6>, n_tensors>
compute_strain_rates(const typename AssumedStrainElement<n_through>::Reference &reference,
                     const typename AssumedStrainElement<n_through>::Kinematics &kinematics,
                     const Frame<Direction> &directions, const Direction (*hourglass)[3]) {
  const Frame<double> &frame = kinematics.frame;
  std::array<Rows<6>, n_tensors> rates{};
  Strains<Direction> by_columns;
  compute_spatial_strains(reference.constants, directions, hourglass,
                          thinning_of<Direction, n_through>(reference, kinematics), by_columns);
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int r = 0; r < 6; ++r)
      for (unsigned int d = 0; d < n_directions; ++d) {
        rates[k][r][d] = by_columns.linear[k][r].rate[d];
        rates[3 + k][r][d] = by_columns.bilinear[k][r].rate[d];
      }
  if constexpr (n_through > 2)
    for (unsigned int r = 0; r < 6; ++r)
      rates[2][r][thinning] = by_columns.linear[2][r].rate[thinning_direction];
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int i = 0; i < 3; ++i) {
      double unit[4][3] = {};
      unit[m][i] = 1.;
      Strains<double> by_vector;
      compute_spatial_strains(reference.constants, frame, unit, no_thinning<double, n_through>(), by_vector);
      for (unsigned int t = 0; t < n_tensors; ++t)
        for (unsigned int r = 0; r < 6; ++r)
          rates[t][r][n_directions + 3 * m + i] = tensor(by_vector, t)[r];
    }
  return rates;
}

/// Tensor, symmetric or not, as plain numbers.
struct Numbers {
  double a[3][3];

  explicit Numbers(const Tensor<2, 3> &tensor) {
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        a[i][j] = tensor[i][j];
  }
  const double *operator[](const unsigned int i) const { return a[i]; }
};

/// Computes the rates of the Kirchhoff stress by the unknowns, from those of the gradient, L = δF
/// F⁻¹ (3 i + j).
void compute_stress_rates(const Numbers &tau, const SpatialModuli &c, const Rows<9> &L, Rows<6> &rates) {
  Rows<6> d;
  for (unsigned int r = 0; r < 6; ++r) {
    const Row &first = L[3 * pair_of[r][0] + pair_of[r][1]], &second = L[3 * pair_of[r][1] + pair_of[r][0]];
    const double factor = r < 3 ? 0.5 : 1.;
    for (unsigned int u = 0; u < width; ++u)
      d[r][u] = factor * (first[u] + second[u]);
  }
  for (unsigned int r = 0; r < 6; ++r) {
    const unsigned int i = pair_of[r][0], j = pair_of[r][1];
    const double c0 = c[r][0], c1 = c[r][1], c2 = c[r][2], c3 = c[r][3], c4 = c[r][4], c5 = c[r][5];
    for (unsigned int u = 0; u < width; ++u)
      rates[r][u] = c0 * d[0][u] + c1 * d[1][u] + c2 * d[2][u] + c3 * d[3][u] + c4 * d[4][u] + c5 * d[5][u];
    const double j0 = tau[0][j], j1 = tau[1][j], j2 = tau[2][j], i0 = tau[0][i], i1 = tau[1][i],
                 i2 = tau[2][i];
    for (unsigned int u = 0; u < width; ++u)
      rates[r][u] += L[3 * i][u] * j0 + L[3 * i + 1][u] * j1 + L[3 * i + 2][u] * j2 + L[3 * j][u] * i0 +
                     L[3 * j + 1][u] * i1 + L[3 * j + 2][u] * i2;
  }
}

/// Does the same for a law in rate form, in which only the deviator depends on L.
void compute_stress_rates(const Numbers &, const GradientModuli &A, const Rows<9> &L, Rows<6> &rates) {
  for (unsigned int r = 0; r < 6; ++r) {
    rates[r].fill(0.);
    for (unsigned int c = 0; c < 9; ++c) {
      const double modulus = A[r][c];
      for (unsigned int u = 0; u < width; ++u)
        rates[r][u] += modulus * L[c][u];
    }
  }
}

template <class Moduli> constexpr bool is_rate_form = false;
template <> constexpr bool is_rate_form<GradientModuli> = true;

/// Sets row = a x + b y + c z.
inline void combine(const double a, const Row &x, const double b, const Row &y, const double c, const Row &z,
                    Row &row) {
  for (unsigned int u = 0; u < width; ++u)
    row[u] = a * x[u] + b * y[u] + c * z[u];
}

/// Adds a point's contribution to the rates of the mean, δp 1 + {δY M + Y δM − Y M Y⁻¹ δY} Y⁻¹,
/// with Z = Y⁻¹ and N = Y M Y⁻¹.
template <unsigned int n_mean>
[[gnu::always_inline]] inline void add_mean_rates(const double weight, const Numbers &M, const Numbers &Y,
                                                  const Numbers &Z, const Numbers &N, const Rows<6> &dY,
                                                  const Rows<6> &dM, const Row &dp, Rows<9> &mean) {
  Rows<9> W;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j) {
      Row &row = W[3 * i + j];
      row.fill(0.);
      for (unsigned int k = 0; k < 3; ++k) {
        const double m = M[k][j], y = Y[i][k], n = N[i][k];
        const Row &dY_ik = dY[symmetric[i][k]], &dM_kj = dM[symmetric[k][j]], &dY_kj = dY[symmetric[k][j]];
        for (unsigned int u = 0; u < n_mean; ++u)
          row[u] += dY_ik[u] * m + y * dM_kj[u] - n * dY_kj[u];
      }
    }
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j) {
      const double z0 = weight * Z[0][j], z1 = weight * Z[1][j], z2 = weight * Z[2][j],
                   own = i == j ? weight : 0.;
      for (unsigned int u = 0; u < n_mean; ++u)
        mean[3 * i + j][u] += W[3 * i][u] * z0 + W[3 * i + 1][u] * z1 + W[3 * i + 2][u] * z2 + own * dp[u];
    }
}

/// Adds the points' contributions to the rates of StressSums by the unknowns; those of the mean
/// only for the first `n_mean` unknowns.
template <unsigned int n_mean, unsigned int n_through, class Moduli>
void add_point_rates(const typename AssumedStrainElement<n_through>::Reference &reference,
                     const typename AssumedStrainElement<n_through>::Kinematics &kinematics,
                     const std::array<Rows<6>, n_tensors> &strain_rates,
                     const typename AssumedStrainElement<n_through>::Stresses &tau,
                     const typename AssumedStrainElement<n_through>::template ModuliOf<Moduli> &moduli,
                     Rows<9> &mean, std::array<Rows<6>, n_tensors> &of_strains) {
  for (unsigned int q = 0; q < tau.size(); ++q) {
    const double weight = point_weight<n_through>(reference.volume, q);
    const auto &own_shares = shares<n_through>[q];
    const Numbers M(dealii::deviator(tau[q])), Y(kinematics.Y[q]), Z(kinematics.inverse_Y[q]);
    const double s0 = own_shares[0], s1 = own_shares[1], s2 = own_shares[2], s3 = own_shares[3],
                 s4 = own_shares[4], s5 = own_shares[5];
    Rows<6> dY;
    for (unsigned int r = 0; r < 6; ++r)
      for (unsigned int u = 0; u < width; ++u)
        dY[r][u] = s0 * strain_rates[0][r][u] + s1 * strain_rates[1][r][u] + s2 * strain_rates[2][r][u] +
                   s3 * strain_rates[3][r][u] + s4 * strain_rates[4][r][u] + s5 * strain_rates[5][r][u];
    Rows<9> A, L; // δY Y⁻¹, and L of the point
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        combine(Z[0][j], dY[symmetric[i][0]], Z[1][j], dY[symmetric[i][1]], Z[2][j], dY[symmetric[i][2]],
                A[3 * i + j]);
    L = A;
    if constexpr (!is_rate_form<Moduli>)
      for (unsigned int u = 0; u < width; ++u) {
        const double third = (A[0][u] + A[4][u] + A[8][u]) * (1. / 3.);
        L[0][u] -= third;
        L[4][u] -= third;
        L[8][u] -= third;
      }
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int j = 0; j < 3; ++j) {
        const double pulled = Z[j][0] * kinematics.frame.duals[k][0] +
                              Z[j][1] * kinematics.frame.duals[k][1] + Z[j][2] * kinematics.frame.duals[k][2];
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int c = 0; c < 3; ++c)
            L[3 * i + j][3 * k + c] += Y[i][c] * pulled;
      }
    Rows<6> dM;
    compute_stress_rates(Numbers(tau[q]), moduli[q], L, dM);
    Row dp;
    for (unsigned int u = 0; u < width; ++u) {
      dp[u] = (dM[0][u] + dM[1][u] + dM[2][u]) * (1. / 3.);
      for (unsigned int r = 0; r < 3; ++r)
        dM[r][u] -= dp[u];
    }
    if constexpr (is_rate_form<Moduli>)
      for (unsigned int u = 0; u < width; ++u)
        dp[u] = u < n_directions ? moduli[q].volumetric * kinematics.frame.duals[u / 3][u % 3] : 0.;

    // sym{(δM − M Aᵀ) Y⁻¹}
    Rows<9> X;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j) {
        combine(-M[i][0], A[3 * j], -M[i][1], A[3 * j + 1], -M[i][2], A[3 * j + 2], X[3 * i + j]);
        for (unsigned int u = 0; u < width; ++u)
          X[3 * i + j][u] += dM[symmetric[i][j]][u];
      }
    for (unsigned int r = 0; r < 6; ++r) {
      const unsigned int i = pair_of[r][0], j = pair_of[r][1];
      const double half = 0.5 * weight;
      Row T, transposed;
      combine(half * Z[0][j], X[3 * i], half * Z[1][j], X[3 * i + 1], half * Z[2][j], X[3 * i + 2], T);
      combine(half * Z[0][i], X[3 * j], half * Z[1][i], X[3 * j + 1], half * Z[2][i], X[3 * j + 2],
              transposed);
      for (unsigned int u = 0; u < width; ++u)
        T[u] += transposed[u];
      for (unsigned int t = 0; t < n_tensors; ++t) {
        const double share = own_shares[t];
        for (unsigned int u = 0; u < width; ++u)
          of_strains[t][r][u] += share * T[u];
      }
    }

    const Numbers N(Tensor<2, 3>(kinematics.Y[q]) * Tensor<2, 3>(dealii::deviator(tau[q])) *
                    Tensor<2, 3>(kinematics.inverse_Y[q]));
    add_mean_rates<n_mean>(weight, M, Y, Z, N, dY, dM, dp, mean);
  }
}

/// Transforms K from the unknowns, of which the first 21 are read, to the nodes.
template <class Reference, std::size_t n>
void scatter(const Reference &reference, const Rows<n> &K, ElementMatrix &matrix) {
  std::array<std::array<double, n_element_dofs>, n_unknowns> half;
  for (unsigned int r = 0; r < n_unknowns; ++r) {
    std::array<double, n_element_nodes> sums[3]{};
    for (unsigned int v = 0; v < n_vectors; ++v)
      for (unsigned int j = 0; j < 3; ++j) {
        const double entry = K[r][3 * v + j];
        for (unsigned int b = 0; b < n_element_nodes; ++b)
          sums[j][b] += entry * reference.of_nodes[v][b];
      }
    for (unsigned int b = 0; b < n_element_nodes; ++b)
      for (unsigned int j = 0; j < 3; ++j)
        half[r][3 * b + j] = sums[j][b];
  }
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int i = 0; i < 3; ++i) {
      double *row = matrix.data() + (std::size_t{3} * a + i) * n_element_dofs;
      std::fill(row, row + n_element_dofs, 0.);
      for (unsigned int v = 0; v < n_vectors; ++v) {
        const double value = reference.of_nodes[v][a];
        for (unsigned int c = 0; c < n_element_dofs; ++c)
          row[c] += value * half[3 * v + i][c];
      }
    }
}

/// Adds the stiffness of W_X, (B9), of a brick with layers to K, and condenses X.
template <unsigned int n_through, std::size_t n>
void add_thinning(const typename AssumedStrainElement<n_through>::Reference &reference,
                  const Frame<double> &frame, const Frame<Direction> &directions,
                  const Direction (*hourglass)[3], Rows<n> &K) {
  Row rates{}; // rates of E − X
  Products<Direction> products;
  strain_modes::multiply(directions, hourglass, products);
  const Direction stretch =
      strain_modes::compute_plane_stretch<double>(reference.constants, directions, products);
  std::copy(stretch.rate, stretch.rate + n_directions, rates.begin());
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int i = 0; i < 3; ++i) {
      double unit[4][3] = {};
      unit[m][i] = 1.;
      Products<double> of_unit;
      strain_modes::multiply(frame, unit, of_unit);
      rates[n_directions + 3 * m + i] =
          strain_modes::compute_plane_stretch<double>(reference.constants, frame, of_unit);
    }
  rates[thinning] = -1.;
  const double stiffness = reference.modulus * reference.volume / 3.;
  for (unsigned int r = 0; r <= thinning; ++r)
    for (unsigned int u = 0; u <= thinning; ++u)
      K[r][u] += stiffness * rates[r] * rates[u];
  const Row &own = K[thinning];
  for (unsigned int r = 0; r < n_unknowns; ++r) {
    const double factor = K[r][thinning] / own[thinning];
    for (unsigned int u = 0; u < n_unknowns; ++u)
      K[r][u] -= factor * own[u];
  }
}

/// Computes the exact tangent, (B6): the part from the rates of the stresses and, at fixed
/// stresses, that from the directions. The latter uses the code of the forces with derivatives by
/// the columns. `is_symmetric` holds for symmetric moduli.
template <bool is_symmetric, unsigned int n_through, class Moduli>
void compute_element_tangent(
    const typename AssumedStrainElement<n_through>::Reference &reference,
    const typename AssumedStrainElement<n_through>::Kinematics &kinematics,
    const typename AssumedStrainElement<n_through>::Stresses &tau,
    const typename AssumedStrainElement<n_through>::template ModuliOf<Moduli> &moduli,
    ElementMatrix &matrix) {
  constexpr bool is_layered = n_through > 2;
  constexpr unsigned int n_mean = is_symmetric ? direction_width : width;
  constexpr unsigned int n_all = n_unknowns + (is_layered ? 1 : 0);
  const Frame<Direction> directions = differentiate(kinematics.frame);
  Direction hourglass[4][3];
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int i = 0; i < 3; ++i)
      hourglass[m][i] = kinematics.hourglass[m][i];
  const auto strain_rates = compute_strain_rates<n_through>(reference, kinematics, directions, hourglass);
  Rows<9> mean{};
  std::array<Rows<6>, n_tensors> of_strains{};
  add_point_rates<n_mean, n_through, Moduli>(reference, kinematics, strain_rates, tau, moduli, mean,
                                             of_strains);

  Rows<n_all> K{};
  for (unsigned int v = 0; v < n_vectors; ++v) {
    // b̂_m contributes no strain that varies as ξ_m, ĉ none that is linear.
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int t = v < 6 ? 0 : 3; t < (v < 3 || v == 6 ? n_tensors : 3); ++t) {
        if (v >= 3 && v < 6 && t == v - 3)
          continue;
        for (unsigned int r = 0; r < 6; ++r) {
          const double rate = (r < 3 ? 1. : 2.) * strain_rates[t][r][3 * v + i];
          for (unsigned int u = 0; u < width; ++u)
            K[3 * v + i][u] += rate * of_strains[t][r][u];
        }
      }
  }
  if constexpr (is_layered)
    for (unsigned int r = 0; r < 6; ++r) {
      const double rate = (r < 3 ? 1. : 2.) * strain_rates[2][r][thinning];
      for (unsigned int u = 0; u < width; ++u)
        K[thinning][u] += rate * of_strains[2][r][u];
    }
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i) {
      const double *a = kinematics.frame.duals[k];
      Row &row = K[3 * k + i];
      const double a0 = a[0], a1 = a[1], a2 = a[2];
      for (unsigned int u = 0; u < n_mean; ++u)
        row[u] += mean[3 * i][u] * a0 + mean[3 * i + 1][u] * a1 + mean[3 * i + 2][u] * a2;
    }
  if constexpr (is_symmetric)
    for (unsigned int r = 0; r < n_directions; ++r)
      for (unsigned int u = n_directions; u < n_all; ++u)
        K[r][u] = K[u][r];

  const auto forces = compute_vector_forces(reference.constants, directions, hourglass,
                                            thinning_of<Direction, n_through>(reference, kinematics),
                                            sum_stresses<n_through>(reference, kinematics, tau));
  for (unsigned int v = 0; v < n_vectors; ++v)
    for (unsigned int i = 0; i < 3; ++i) {
      for (unsigned int d = 0; d < n_directions; ++d) {
        K[3 * v + i][d] += forces[v][i].rate[d];
        if (v >= 3)
          K[d][3 * v + i] += forces[v][i].rate[d];
      }
      if constexpr (is_layered) {
        K[3 * v + i][thinning] += forces[v][i].rate[thinning_direction];
        K[thinning][3 * v + i] += forces[v][i].rate[thinning_direction];
      }
    }
  if constexpr (is_layered)
    add_thinning<n_through>(reference, kinematics.frame, directions, hourglass, K);
  scatter(reference, K, matrix);
}

} // namespace

strain_modes::Constants<double> compute_strain_constants(const ElasticModuli &elastic,
                                                         const std::array<double, 3> &lengths,
                                                         const double kept_through) {
  const double theta = strain_modes::kept_shear;
  const double nu = poisson_ratio(elastic);
  strain_modes::Constants<double> constants{};
  for (unsigned int j = 0; j < 3; ++j)
    for (unsigned int k = 0; k < 3; ++k)
      if (j != k) {
        const double kept = std::min(k == 2 ? kept_through : theta, lengths[j] / lengths[k]);
        constants.share[j][k] = 1. / std::sqrt(1. + 0.5 * kept * kept);
        constants.shear[j][k] = kept * constants.share[j][k];
      }
  for (unsigned int k = 0; k < 3; ++k) {
    const double both = constants.share[(k + 1) % 3][k] * constants.share[(k + 2) % 3][k];
    // The bound avoids a negative radicand as ν approaches −1.
    constants.thinning[k] = 0.5 * (std::sqrt(std::max(0., 3. + 6. * nu / ((1. - nu) * both))) - 1.);
  }
  constants.fourth = std::sqrt(2. * (1. + nu) / (3. * (1. + 2. / 3. * theta * theta)));
  return constants;
}

template <unsigned int n_through>
bool AssumedStrainElement<n_through>::initialize(const ElementVectors &positions, Reference &reference,
                                                 const ThicknessAxis &axis) const {
  ReferenceElement points; // a brick that is invalid with eight points is rejected
  if (!compute_reference_element(positions, points))
    return false;
  std::array<unsigned int, n_element_nodes> corners{};
  std::iota(corners.begin(), corners.end(), 0U);
  ElementVectors turned = positions;
  if constexpr (is_layered) {
    corners = turn_corners(axis);
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        turned[3 * a + i] = positions[3 * corners[a] + i];
  }
  const ModalGeometry geometry(turned);
  std::array<double, 3> lengths{};
  for (unsigned int k = 0; k < 3; ++k) {
    lengths[k] = geometry.modes[k].norm();
    for (unsigned int i = 0; i < 3; ++i)
      reference.jacobian[i][k] = geometry.modes[k][i];
  }
  if (!(dealii::determinant(reference.jacobian) > 0.))
    return false;
  reference.inverse_jacobian = dealii::invert(reference.jacobian);
  reference.volume = geometry.volume;
  reference.constants = compute_strain_constants(
      elastic_, lengths, is_layered ? kept_shear_of_layers : strain_modes::kept_shear);
  if constexpr (is_layered) {
    const double nu = poisson_ratio(elastic_), part = nu / (1. - nu);
    const auto &share = reference.constants.share;
    // The bounds keep the modulus finite and positive as ν approaches ½ and −1.
    constexpr double minimum = -0.45;
    const double counted =
        std::max(minimum, std::min(part / (share[0][2] * share[1][2]), 1. - 0.25 * (1. - part)));
    const double ratio = counted / (1. - counted);
    reference.modulus = 2. * elastic_.shear * (1. / 3. + ratio);
    reference.elastic_part = ratio / (1. + ratio);
  }
  for (unsigned int a = 0; a < n_element_nodes; ++a) {
    for (unsigned int k = 0; k < 3; ++k) {
      double &of_node = reference.of_nodes[k][corners[a]];
      of_node = 0.;
      for (unsigned int m = 0; m < n_linear_modes; ++m)
        of_node += 0.125 * geometry.beta[m][k] * mode_values[m][a];
    }
    for (unsigned int m = 0; m < 4; ++m) {
      const Tensor<1, 3> own = reference.inverse_jacobian * geometry.modes[3 + m];
      double &of_node = reference.of_nodes[3 + m][corners[a]];
      of_node = 0.125 * mode_values[3 + m][a];
      for (unsigned int k = 0; k < 3; ++k)
        of_node -= own[k] * reference.of_nodes[k][corners[a]];
    }
  }
  return true;
}

namespace {

/// Computes the points' gradients from Y. Returns false if one is inadmissible.
template <class Kinematics> bool complete_points(const Tensor<2, 3> &mean_F, Kinematics &kinematics) {
  for (unsigned int q = 0; q < kinematics.Y.size(); ++q) {
    const SymmetricTensor<2, 3> &Y = kinematics.Y[q];
    const double determinant = dealii::determinant(Y);
    // Y must be positive definite: neither one nor two fibres are inverted.
    if (!(determinant > 0.) || !(dealii::trace(Y) > 0.) || !(dealii::second_invariant(Y) > 0.) ||
        !std::isfinite(determinant))
      return false;
    kinematics.inverse_Y[q] = dealii::invert(Y);
    kinematics.F_of_rates[q] = Tensor<2, 3>(Y) * mean_F;
    kinematics.F[q] = kinematics.F_of_rates[q] / std::cbrt(determinant);
  }
  return true;
}

template <unsigned int n_through>
void set_strains(const Strains<double> &strains,
                 std::array<SymmetricTensor<2, 3>, 4 * n_through> &of_points) {
  for (unsigned int q = 0; q < of_points.size(); ++q) {
    SymmetricTensor<2, 3> &Y = of_points[q];
    Y = dealii::unit_symmetric_tensor<3>();
    for (unsigned int t = 0; t < n_tensors; ++t)
      for (unsigned int r = 0; r < 6; ++r)
        Y[pair_of[r][0]][pair_of[r][1]] += shares<n_through>[q][t] * tensor(strains, t)[r];
  }
}

} // namespace

template <unsigned int n_through>
bool AssumedStrainElement<n_through>::compute(const Reference &reference, const ElementVectors &displacements,
                                              Kinematics &kinematics) {
  std::array<Tensor<1, 3>, n_vectors> moved;
  for (unsigned int v = 0; v < n_vectors; ++v)
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        moved[v][i] += reference.of_nodes[v][a] * displacements[3 * a + i];
  Tensor<2, 3> change;
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i) {
      change[i][k] = moved[k][i];
      kinematics.frame.columns[k][i] = reference.jacobian[i][k] + moved[k][i];
    }
  Tensor<2, 3> F = change * reference.inverse_jacobian;
  for (unsigned int i = 0; i < 3; ++i)
    F[i][i] += 1.;
  kinematics.J = dealii::determinant(F);
  if (!(kinematics.J > 0.) || !std::isfinite(kinematics.J))
    return false;
  kinematics.volume = kinematics.J * reference.volume;
  strain_modes::complete(kinematics.frame, reciprocal, root);
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int i = 0; i < 3; ++i)
      kinematics.hourglass[m][i] = moved[3 + m][i];
  if constexpr (is_layered) {
    kinematics.mean_F = F;
    compute_spatial_strains(reference.constants, kinematics.frame, kinematics.hourglass,
                            no_thinning<double, n_through>(), kinematics.strains);
    Products<double> products;
    strain_modes::multiply(kinematics.frame, kinematics.hourglass, products);
    kinematics.stretch =
        strain_modes::compute_plane_stretch<double>(reference.constants, kinematics.frame, products);
    return std::isfinite(kinematics.stretch);
  } else {
    Strains<double> strains;
    compute_spatial_strains(reference.constants, kinematics.frame, kinematics.hourglass,
                            no_thinning<double, n_through>(), strains);
    set_strains<n_through>(strains, kinematics.Y);
    return complete_points(F, kinematics);
  }
}

template <unsigned int n_through>
bool AssumedStrainElement<n_through>::set_thinning(const double strain, Kinematics &kinematics) {
  kinematics.thinning = strain;
  Strains<double> strains = kinematics.strains;
  const double *normal = kinematics.frame.duals[2];
  const double factor = strain * kinematics.frame.square_heights[2];
  for (unsigned int r = 0; r < 6; ++r)
    strains.linear[2][r] -= factor * normal[pair_of[r][0]] * normal[pair_of[r][1]];
  set_strains<n_through>(strains, kinematics.Y);
  return complete_points(kinematics.mean_F, kinematics);
}

template <unsigned int n_through>
double AssumedStrainElement<n_through>::reference_volume(const Reference &reference, const unsigned int q) {
  return point_weight<n_through>(reference.volume, q);
}

template <unsigned int n_through>
template <bool>
void AssumedStrainElement<n_through>::add_force(const Reference &reference, const Kinematics &kinematics,
                                                const Stresses &tau, ElementVectors &force) {
  const auto forces = compute_vector_forces(reference.constants, kinematics.frame, kinematics.hourglass,
                                            thinning_of<double, n_through>(reference, kinematics),
                                            sum_stresses<n_through>(reference, kinematics, tau));
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int v = 0; v < n_vectors; ++v)
      for (unsigned int i = 0; i < 3; ++i)
        force[3 * a + i] += reference.of_nodes[v][a] * forces[v][i];
}

template <unsigned int n_through>
void AssumedStrainElement<n_through>::compute_symmetric_tangent(const Reference &reference,
                                                                const Kinematics &kinematics,
                                                                const Stresses &tau,
                                                                const ModuliOf<SpatialModuli> &moduli,
                                                                ElementMatrix &matrix) {
  compute_element_tangent<true, n_through, SpatialModuli>(reference, kinematics, tau, moduli, matrix);
}

template <unsigned int n_through>
template <class Moduli>
void AssumedStrainElement<n_through>::compute_unsymmetric_tangent(const Reference &reference,
                                                                  const Kinematics &kinematics,
                                                                  const Stresses &tau,
                                                                  const ModuliOf<Moduli> &moduli,
                                                                  ElementMatrix &matrix) const {
  compute_element_tangent<false, n_through, Moduli>(reference, kinematics, tau, moduli, matrix);
}

template <unsigned int n_through>
double AssumedStrainElement<n_through>::varying_pressure(const Reference &reference,
                                                         const Kinematics &kinematics, const unsigned int q) {
  return reference.modulus * (kinematics.thinning - kinematics.stretch) * shares<n_through>[q][2];
}

template <unsigned int n_through>
double AssumedStrainElement<n_through>::thinning_residual(const Reference &reference,
                                                          const Kinematics &kinematics, const Stresses &tau) {
  const double *normal = kinematics.frame.duals[2];
  double sum = 0.;
  for (unsigned int q = 0; q < n_points; ++q) {
    const Tensor<2, 3> by_inverse =
        Tensor<2, 3>(dealii::deviator(tau[q])) * Tensor<2, 3>(kinematics.inverse_Y[q]);
    double along = 0.;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        along += normal[i] * by_inverse[i][j] * normal[j];
    sum += point_weight<n_through>(reference.volume, q) * shares<n_through>[q][2] * along;
  }
  return -kinematics.frame.square_heights[2] * sum - thinning_force(reference, kinematics);
}

#define BILLET_INSTANTIATE(n)                                                                                \
  template bool AssumedStrainElement<n>::initialize(const ElementVectors &, Reference &,                     \
                                                    const ThicknessAxis &) const;                            \
  template bool AssumedStrainElement<n>::compute(const Reference &, const ElementVectors &, Kinematics &);   \
  template double AssumedStrainElement<n>::reference_volume(const Reference &, unsigned int);                \
  template void AssumedStrainElement<n>::add_force<false>(const Reference &, const Kinematics &,             \
                                                          const Stresses &, ElementVectors &);               \
  template void AssumedStrainElement<n>::add_force<true>(const Reference &, const Kinematics &,              \
                                                         const Stresses &, ElementVectors &);                \
  template void AssumedStrainElement<n>::compute_symmetric_tangent(                                          \
      const Reference &, const Kinematics &, const Stresses &, const ModuliOf<SpatialModuli> &,              \
      ElementMatrix &);                                                                                      \
  template void AssumedStrainElement<n>::compute_unsymmetric_tangent<SpatialModuli>(                         \
      const Reference &, const Kinematics &, const Stresses &, const ModuliOf<SpatialModuli> &,              \
      ElementMatrix &) const;                                                                                \
  template void AssumedStrainElement<n>::compute_unsymmetric_tangent<GradientModuli>(                        \
      const Reference &, const Kinematics &, const Stresses &, const ModuliOf<GradientModuli> &,             \
      ElementMatrix &) const;
#define BILLET_INSTANTIATE_LAYERS(n)                                                                         \
  BILLET_INSTANTIATE(n)                                                                                      \
  template bool AssumedStrainElement<n>::set_thinning(double, Kinematics &);                                 \
  template double AssumedStrainElement<n>::varying_pressure(const Reference &, const Kinematics &,           \
                                                            unsigned int);                                   \
  template double AssumedStrainElement<n>::thinning_residual(const Reference &, const Kinematics &,          \
                                                             const Stresses &);

BILLET_INSTANTIATE(2)
BILLET_INSTANTIATE_LAYERS(3)
BILLET_INSTANTIATE_LAYERS(5)
BILLET_INSTANTIATE_LAYERS(7)

} // namespace billet
