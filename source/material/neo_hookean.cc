// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/neo_hookean.h"

#include <cmath>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

double complete_unimodular(const SymmetricTensor<2, 3> &X) {
  const double i_2 = 0.5 * (X * X), i_3 = dealii::determinant(X);
  double x = 1. + X.norm(); // beyond the largest root: Newton comes down to it
  for (unsigned int i = 0; i < 100; ++i) {
    const double change = (x * x * x - i_2 * x + i_3 - 1.) / (3. * x * x - i_2);
    x -= change;
    if (!(change > 1e-16 * x))
      break;
  }
  return x;
}

bool compute_isochoric_state(const Tensor<2, 3> &F, const SymmetricTensor<2, 3> &metric,
                             IsochoricState &state) {
  state.J = dealii::determinant(F);
  if (!(state.J > 0.) || !std::isfinite(state.J))
    return false;
  const double root = std::cbrt(state.J);
  const SymmetricTensor<2, 3> b =
      dealii::symmetrize(F * static_cast<Tensor<2, 3>>(metric) * dealii::transpose(F)) / (root * root);
  state.mean = dealii::trace(b) / 3.;
  state.deviator = dealii::deviator(b);
  return std::isfinite(b.norm());
}

double compute_elastic_energy(const ElasticModuli &elastic, const IsochoricState &state) {
  const double log_J = std::log(state.J), x = state.mean;
  const double i_2 = 0.5 * (state.deviator * state.deviator), i_3 = dealii::determinant(state.deviator);
  return 0.5 * elastic.bulk * log_J * log_J + 1.5 * elastic.shear * (i_2 * x - i_3) / (x * (x + 1.) + 1.);
}

void compute_neo_hookean_moduli(const ElasticModuli &elastic, const IsochoricState &state, const double beta,
                                const SymmetricTensor<2, 3> &beta_rate, SpatialModuli &moduli) {
  constexpr unsigned int rows[6] = {0, 1, 2, 0, 0, 1}, columns[6] = {0, 1, 2, 1, 2, 2};
  const double pressure = elastic.bulk * std::log(state.J);
  const double two_mu_bar = 2. * elastic.shear * state.mean;
  const double identity = beta * two_mu_bar - 2. * pressure, dilation = elastic.bulk - beta * two_mu_bar / 3.;
  std::array<double, 6> s{}, rate{};
  for (unsigned int i = 0; i < 6; ++i) {
    s[i] = elastic.shear * state.deviator[rows[i]][columns[i]];
    rate[i] = beta_rate[rows[i]][columns[i]];
  }
  for (unsigned int i = 0; i < 6; ++i)
    for (unsigned int j = 0; j < 6; ++j)
      moduli[i][j] = s[i] * rate[j] + (i == j ? (i < 3 ? identity : 0.5 * identity) : 0.) +
                     (i < 3 && j < 3 ? dilation : 0.) -
                     (2. / 3.) * beta * ((i < 3 ? s[j] : 0.) + (j < 3 ? s[i] : 0.));
}

} // namespace billet
