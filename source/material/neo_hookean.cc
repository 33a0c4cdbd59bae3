// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/neo_hookean.h"

#include <cmath>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

double complete_unimodular(const SymmetricTensor<2, 3> &X) {
  const double i_2 = 0.5 * (X * X), i_3 = dealii::determinant(X);
  double x = 1. + X.norm(); // above the largest root: Newton's method decreases monotonically to it
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

namespace {

/// Returns ∂β with β = σ_y(α + Δα)/q, q − m Δα = σ_y(α + Δα), k = σ_y'/(m + σ_y'), and the rates of
/// q and m = 3 μ̄:
///   q q̇ = (m s + 3 dev s²) : d,   ṁ = 2 s : d.
dealii::SymmetricTensor<2, 3> compute_beta_rate(const dealii::SymmetricTensor<2, 3> &s, const double q,
                                                const double m, const double beta, const double k,
                                                const double delta_alpha) {
  const dealii::Tensor<2, 3> matrix = s;
  return ((k - beta) / q * (m * s + 3. * dealii::deviator(dealii::symmetrize(matrix * matrix))) -
          (2. * k * delta_alpha) * s) /
         q;
}

} // namespace

bool NeoHookeanPlasticity::update(const dealii::Tensor<2, 3> &F, const History &history_n, History &history,
                                  dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli,
                                  const PointStep &step) const {
  IsochoricState trial;
  if (!compute_isochoric_state(F, history_n.inverse_plastic_metric, trial))
    return false;
  const dealii::SymmetricTensor<2, 3> s = elastic_.shear * trial.deviator;
  const double alpha_n = history_n.equivalent_plastic_strain;
  const double q =
      std::sqrt(1.5 * (s * s) + (step.shared != nullptr ? 6. * elastic_.shear * step.shared->energy : 0.));
  const double yield_stress = flow_->stress(alpha_n);
  double beta = 1., delta_alpha = 0.;
  dealii::SymmetricTensor<2, 3> beta_rate;
  if (q > yield_stress * (1. + step.yield_slack)) {
    const double m = 3. * elastic_.shear * trial.mean;
    const PlasticIncrement increment = flow_->solve(q, m, alpha_n, step.dt);
    delta_alpha = increment.strain;
    beta = 1. - m * delta_alpha / q;
    const double k = increment.slope / (m + increment.slope);
    if (moduli != nullptr)
      beta_rate = compute_beta_rate(s, q, m, beta, k, delta_alpha);
    if (step.shared != nullptr) {
      step.shared->share = beta;
      step.shared->slope = 3. * elastic_.shear * (k - beta) / (q * q);
      step.shared->rate = beta_rate;
    }
  }
  tau = beta * s + elastic_.bulk * std::log(trial.J) * dealii::unit_symmetric_tensor<3>();
  if (moduli != nullptr)
    compute_neo_hookean_moduli(elastic_, trial, beta, beta_rate, *moduli);

  history = history_n;
  if (delta_alpha > 0.) {
    history.equivalent_plastic_strain += delta_alpha;
    flow_->advance(alpha_n, delta_alpha, step.dt, history_n.flow, history.flow);
    // F⁻¹ b̄_e F⁻ᵀ with b̄_e = β dev b̄_trial + x 1: only a multiple of C⁻¹ is added.
    const double x = complete_unimodular(beta * trial.deviator);
    const dealii::SymmetricTensor<2, 3> C_inverse =
        dealii::invert(dealii::symmetrize(dealii::transpose(F) * F));
    history.inverse_plastic_metric = beta * history_n.inverse_plastic_metric +
                                     (x - beta * trial.mean) * std::cbrt(trial.J * trial.J) * C_inverse;
  }
  return true;
}

double NeoHookeanPlasticity::elastic_energy(const dealii::Tensor<2, 3> &F, const History &history) const {
  IsochoricState state;
  return compute_isochoric_state(F, history.inverse_plastic_metric, state)
             ? compute_elastic_energy(elastic_, state)
             : 0.;
}

NeoHookeanPlasticity::History
NeoHookeanPlasticity::find_history(const dealii::Tensor<2, 3> &F,
                                   const dealii::SymmetricTensor<2, 3> &deviator,
                                   const double equivalent_plastic_strain) const {
  const dealii::SymmetricTensor<2, 3> X = deviator / elastic_.shear;
  return history_of(F, X + complete_unimodular(X) * dealii::unit_symmetric_tensor<3>(),
                    equivalent_plastic_strain);
}

} // namespace billet
