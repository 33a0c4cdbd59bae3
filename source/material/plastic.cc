// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/plastic.h"

#include <cmath>

namespace billet {

bool HenckyPlasticity::update(const dealii::Tensor<2, 3> &F, const History &history_n, History &history,
                              dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli,
                              const PointStep &step) const {
  PrincipalElasticState trial;
  PrincipalResponse response;
  double delta_alpha = 0.;
  if (!respond(F, history_n, step, trial, response, delta_alpha))
    return false;
  tau = compute_kirchhoff_stress(trial, response);
  if (moduli != nullptr)
    compute_spatial_moduli(trial, response, elastic_, *moduli);

  history = history_n;
  if (delta_alpha > 0.) {
    history.equivalent_plastic_strain += delta_alpha;
    flow_->advance(history_n.equivalent_plastic_strain, delta_alpha, step.dt, history_n.flow, history.flow);
    // After the return map, b_e = Σ exp(2 ε_e) m_A; C_p⁻¹ = F⁻¹ b_e F⁻ᵀ.
    dealii::SymmetricTensor<2, 3> b_e;
    for (unsigned int a = 0; a < 3; ++a)
      b_e += std::exp(2. *
                      (trial.volumetric_log_strain / 3. + response.beta * trial.deviatoric_log_strains[a])) *
             dealii::symmetrize(dealii::outer_product(trial.directions[a], trial.directions[a]));
    const dealii::Tensor<2, 3> F_inverse = dealii::invert(F);
    history.inverse_plastic_metric =
        dealii::symmetrize(F_inverse * static_cast<dealii::Tensor<2, 3>>(b_e) * dealii::transpose(F_inverse));
  }
  return true;
}

double HenckyPlasticity::elastic_energy(const dealii::Tensor<2, 3> &F, const History &history) const {
  PrincipalElasticState trial;
  PrincipalResponse response;
  double delta_alpha = 0.;
  return respond(F, history, {}, trial, response, delta_alpha) ? compute_elastic_energy(elastic_, trial) : 0.;
}

HenckyPlasticity::History HenckyPlasticity::find_history(const dealii::Tensor<2, 3> &F,
                                                         const dealii::SymmetricTensor<2, 3> &deviator,
                                                         const double equivalent_plastic_strain) const {
  return history_of(F, exponential(deviator / elastic_.shear), equivalent_plastic_strain);
}

bool HenckyPlasticity::respond(const dealii::Tensor<2, 3> &F, const History &history_n, const PointStep &step,
                               PrincipalElasticState &trial, PrincipalResponse &response,
                               double &delta_alpha) const {
  const dealii::Tensor<2, 3> C_p_inverse = history_n.inverse_plastic_metric;
  const double J = dealii::determinant(F);
  if (!(J > 0.) ||
      !compute_principal_state(dealii::symmetrize(F * C_p_inverse * dealii::transpose(F)), trial))
    return false;
  // This keeps det C_p = 1 exactly; with Σ ε_A, round-off would accumulate over the steps to a
  // pressure.
  trial.volumetric_log_strain = std::log(J);

  const double two_g = 2. * elastic_.shear;
  double dev_norm = 0.;
  for (const double e : trial.deviatoric_log_strains)
    dev_norm += e * e;
  const double three_g = 3. * elastic_.shear;
  const double own = two_g * three_g * dev_norm; // square of the trial state's von Mises stress
  const double q = std::sqrt(own + (step.shared != nullptr ? 2. * three_g * step.shared->energy : 0.));
  dev_norm = std::sqrt(dev_norm);

  delta_alpha = 0.;
  const double alpha_n = history_n.equivalent_plastic_strain;
  const double yield_stress = flow_->stress(alpha_n);
  if (q > yield_stress * (1. + step.yield_slack)) {
    const PlasticIncrement increment = flow_->solve(q, three_g, alpha_n, step.dt);
    delta_alpha = increment.strain;
    const double reduction = three_g * delta_alpha / q;
    response.beta = 1. - reduction;
    const double gamma = three_g / (three_g + increment.slope) - reduction;
    if (dev_norm > 0.) {
      response.gamma = gamma * own / (q * q);
      for (unsigned int a = 0; a < 3; ++a)
        response.flow_direction[a] = trial.deviatoric_log_strains[a] / dev_norm;
    }
    if (step.shared != nullptr) {
      step.shared->share = response.beta;
      step.shared->slope = -gamma * three_g / (q * q);
      for (unsigned int a = 0; a < 3; ++a)
        step.shared->rate += step.shared->slope * two_g * trial.deviatoric_log_strains[a] *
                             dealii::outer_product(trial.directions[a], trial.directions[a]);
    }
  }
  for (unsigned int a = 0; a < 3; ++a)
    response.stress[a] =
        elastic_.bulk * trial.volumetric_log_strain + two_g * response.beta * trial.deviatoric_log_strains[a];
  return true;
}

} // namespace billet
