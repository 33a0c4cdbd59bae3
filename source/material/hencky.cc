// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/hencky.h"

#include <cmath>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

bool compute_principal_state(const SymmetricTensor<2, 3> &b, PrincipalElasticState &state) {
  if (!std::isfinite(b.norm()))
    return false;
  // Jacobi's method is the most accurate of the three, also for nearly coincident eigenvalues.
  const auto pairs = dealii::eigenvectors(b, dealii::SymmetricTensorEigenvectorMethod::jacobi);
  std::array<double, 3> log_strains{};
  for (unsigned int a = 0; a < 3; ++a) {
    if (!(pairs[a].first > 0.))
      return false;
    state.stretches_squared[a] = pairs[a].first;
    state.directions[a] = pairs[a].second;
    log_strains[a] = 0.5 * std::log(pairs[a].first);
  }
  state.volumetric_log_strain = log_strains[0] + log_strains[1] + log_strains[2];
  for (unsigned int a = 0; a < 3; ++a)
    state.deviatoric_log_strains[a] = log_strains[a] - state.volumetric_log_strain / 3.;
  return true;
}

SymmetricTensor<2, 3> exponential(const SymmetricTensor<2, 3> &A) {
  SymmetricTensor<2, 3> result;
  for (const auto &[value, direction] :
       dealii::eigenvectors(A, dealii::SymmetricTensorEigenvectorMethod::jacobi))
    result += std::exp(value) * dealii::symmetrize(dealii::outer_product(direction, direction));
  return result;
}

SymmetricTensor<2, 3> compute_kirchhoff_stress(const PrincipalElasticState &trial,
                                               const PrincipalResponse &response) {
  SymmetricTensor<2, 3> tau;
  for (unsigned int a = 0; a < 3; ++a)
    tau += response.stress[a] *
           dealii::symmetrize(dealii::outer_product(trial.directions[a], trial.directions[a]));
  return tau;
}

std::array<double, 6> symmetric_dyad(const Tensor<1, 3> &a, const Tensor<1, 3> &b) {
  return {a[0] * b[0],
          a[1] * b[1],
          a[2] * b[2],
          0.5 * (a[0] * b[1] + a[1] * b[0]),
          0.5 * (a[0] * b[2] + a[2] * b[0]),
          0.5 * (a[1] * b[2] + a[2] * b[1])};
}

namespace {

using Vector6 = std::array<double, 6>;

void add_dyad(SpatialModuli &moduli, const double factor, const Vector6 &v, const Vector6 &w) {
  for (unsigned int i = 0; i < 6; ++i)
    for (unsigned int j = 0; j < 6; ++j)
      moduli[i][j] += factor * v[i] * w[j];
}

/// Returns ln(1 + x)/x, 1 at x = 0.
double log_ratio(const double x) { return x == 0. ? 1. : std::log1p(x) / x; }

} // namespace

void compute_spatial_moduli(const PrincipalElasticState &trial, const PrincipalResponse &response,
                            const ElasticModuli &elastic, SpatialModuli &moduli) {
  const auto &b = trial.stretches_squared;
  const double two_g_beta = 2. * elastic.shear * response.beta;
  for (auto &row : moduli)
    row.fill(0.);

  std::array<Vector6, 3> m;
  for (unsigned int a = 0; a < 3; ++a)
    m[a] = symmetric_dyad(trial.directions[a], trial.directions[a]);

  for (unsigned int a = 0; a < 3; ++a) {
    Vector6 row{};
    for (unsigned int c = 0; c < 3; ++c) {
      const double derivative =
          elastic.bulk + two_g_beta * ((a == c ? 1. : 0.) - 1. / 3.) -
          2. * elastic.shear * response.gamma * response.flow_direction[a] * response.flow_direction[c] -
          (a == c ? 2. * response.stress[a] : 0.);
      for (unsigned int i = 0; i < 6; ++i)
        row[i] += derivative * m[c][i];
    }
    add_dyad(moduli, 1., m[a], row);
  }

  for (unsigned int a = 0; a < 3; ++a)
    for (unsigned int c = a + 1; c < 3; ++c) {
      const double x = (b[a] - b[c]) / b[c];
      const double g = 0.5 * two_g_beta * log_ratio(x) - response.stress[c];
      const Vector6 s = symmetric_dyad(trial.directions[a], trial.directions[c]);
      add_dyad(moduli, 4. * g, s, s);
    }
}

} // namespace billet
