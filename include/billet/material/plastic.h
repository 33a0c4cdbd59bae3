// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_PLASTIC_H
#define BILLET_MATERIAL_PLASTIC_H

#include "billet/material/elastic.h"
#include "billet/material/hardening.h"

#include <cmath>
#include <limits>

namespace billet {

/// The yield condition that a point shares with the stabilisation of its element, (X7) of doc/theory.md:
/// √(q² + 6 G W) = σ_y, as W = σ_y²/6G is what a yielding point stores. The return leaves the same share of
/// both stresses.
struct SharedYield {
  double energy = 0.;        ///< W: what the stabilisation would store without flow [energy/volume]
  double share = 1.;         ///< β
  double slope = 0.;         ///< ∂β/∂W
  dealii::Tensor<2, 3> rate; ///< ∂β : L is the rate of β at given W
};

/// Solves q − 3G Δα − σ_y(α_n + Δα) = 0 for Δα > 0, given that the left side is positive at Δα = 0. Newton,
/// kept inside a shrinking bracket: hardening laws with kinks or steep starts cannot throw it off. Ends at
/// round-off.
template <class Hardening>
double solve_consistency(const Hardening &hardening, const double q, const double three_g,
                         const double alpha_n) {
  double low = 0., high = q / three_g;
  double delta = 0.;
  const double tolerance = 4. * std::numeric_limits<double>::epsilon() * q;
  for (unsigned int i = 0; i < 200; ++i) {
    const double f = q - three_g * delta - hardening.stress(alpha_n + delta);
    if (std::abs(f) <= tolerance)
      break;
    (f > 0. ? low : high) = delta;
    double next = delta + f / (three_g + hardening.slope(alpha_n + delta));
    if (!(next > low && next < high))
      next = 0.5 * (low + high);
    if (next == delta)
      break;
    delta = next;
  }
  return delta;
}

/// What laws with F = F_e F_p keep of a point.
class MultiplicativePlasticity {
public:
  struct History {
    dealii::SymmetricTensor<2, 3> inverse_plastic_metric = dealii::unit_symmetric_tensor<3>(); ///< C_p⁻¹
    double equivalent_plastic_strain = 0.;                                                     ///< α
  };

  /// A history as numbers.
  static constexpr unsigned int n_history = 7;
  static void store(const History &history, double *numbers) {
    for (unsigned int i = 0; i < 6; ++i)
      numbers[i] = history.inverse_plastic_metric.access_raw_entry(i);
    numbers[6] = history.equivalent_plastic_strain;
  }
  static History restore(const double *numbers) {
    History history;
    for (unsigned int i = 0; i < 6; ++i)
      history.inverse_plastic_metric.access_raw_entry(i) = numbers[i];
    history.equivalent_plastic_strain = numbers[6];
    return history;
  }

  static double equivalent_plastic_strain(const History &history) {
    return history.equivalent_plastic_strain;
  }

protected:
  /// With which F has this b̄_e: C_p⁻¹ = J^{2/3} F⁻¹ b̄_e F⁻ᵀ.
  static History history_of(const dealii::Tensor<2, 3> &F, const dealii::Tensor<2, 3> &b_e,
                            const double equivalent_plastic_strain) {
    const dealii::Tensor<2, 3> F_inverse = dealii::invert(F);
    return {std::pow(dealii::determinant(F), 2. / 3.) *
                dealii::symmetrize(F_inverse * b_e * dealii::transpose(F_inverse)),
            equivalent_plastic_strain};
  }
};

/// Multiplicative J2 plasticity with Hencky elasticity: F = F_e F_p, Kirchhoff stress linear in the elastic
/// logarithmic strain, yield |τ| = σ_y(α) in the sense of von Mises in *Kirchhoff* stress, associated flow by
/// the exponential map. The return map is radial in logarithmic principal space and exact (Simo & Hughes
/// 1998, box 9.1; Eterovic & Bathe 1990).
template <class Hardening> class HenckyPlasticity : public MultiplicativePlasticity {
public:
  using Moduli = SpatialModuli;
  static constexpr bool has_plasticity = true, has_history = true, is_rate_form = false,
                        has_symmetric_moduli = true;

  HenckyPlasticity(const ElasticModuli &elastic, Hardening hardening)
      : elastic_(elastic), hardening_(std::move(hardening)) {}

  /// From the deformation gradient F at the end of a step and the history at its start: Kirchhoff stress
  /// `tau` [stress], the history at its end, and, if `moduli` is given, the consistent tangent. `history_n`
  /// and `history` may not be the same object. False where F is not admissible (not finite, singular): the
  /// step has to be cut. A point yields where q > σ_y (1 + `yield_slack`): in a state that has just yielded,
  /// where round-off would decide, 1e-9 gives the tangent of unloading, −1e-9 that of further loading. With
  /// `shared`, whose energy is given, q is that of both; its other numbers are answers.
  bool update(const dealii::Tensor<2, 3> &F, const History &history_n, History &history,
              dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli, const double yield_slack = 0.,
              SharedYield *shared = nullptr) const {
    PrincipalElasticState trial;
    PrincipalResponse response;
    double delta_alpha = 0.;
    if (!respond(F, history_n, yield_slack, shared, trial, response, delta_alpha))
      return false;
    tau = compute_kirchhoff_stress(trial, response);
    if (moduli != nullptr)
      compute_spatial_moduli(trial, response, elastic_, *moduli);

    history = history_n;
    if (delta_alpha > 0.) {
      history.equivalent_plastic_strain += delta_alpha;
      // b_e = Σ exp(2 ε_e) m_A after the return; C_p⁻¹ = F⁻¹ b_e F⁻ᵀ.
      dealii::SymmetricTensor<2, 3> b_e;
      for (unsigned int a = 0; a < 3; ++a)
        b_e += std::exp(2. * (trial.volumetric_log_strain / 3. +
                              response.beta * trial.deviatoric_log_strains[a])) *
               dealii::symmetrize(dealii::outer_product(trial.directions[a], trial.directions[a]));
      const dealii::Tensor<2, 3> F_inverse = dealii::invert(F);
      history.inverse_plastic_metric = dealii::symmetrize(F_inverse * static_cast<dealii::Tensor<2, 3>>(b_e) *
                                                          dealii::transpose(F_inverse));
    }
    return true;
  }

  /// Stored energy per reference volume [stress] at F with a history that belongs to F.
  double elastic_energy(const dealii::Tensor<2, 3> &F, const History &history) const {
    PrincipalElasticState trial;
    PrincipalResponse response;
    double delta_alpha = 0.;
    return respond(F, history, 0., nullptr, trial, response, delta_alpha)
               ? compute_elastic_energy(elastic_, trial)
               : 0.;
  }

  /// The history with which `F` has the Kirchhoff stress of this deviator, where that is below the yield
  /// stress: b̄_e = exp(dev τ/G).
  History find_history(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &deviator,
                       const double equivalent_plastic_strain) const {
    return history_of(F, exponential(deviator / elastic_.shear), equivalent_plastic_strain);
  }

  double plastic_work(const History &history) const {
    return hardening_.work(history.equivalent_plastic_strain);
  }

private:
  bool respond(const dealii::Tensor<2, 3> &F, const History &history_n, const double yield_slack,
               SharedYield *shared, PrincipalElasticState &trial, PrincipalResponse &response,
               double &delta_alpha) const {
    const dealii::Tensor<2, 3> C_p_inverse = history_n.inverse_plastic_metric;
    const double J = dealii::determinant(F);
    if (!(J > 0.) ||
        !compute_principal_state(dealii::symmetrize(F * C_p_inverse * dealii::transpose(F)), trial))
      return false;
    // det C_p = 1 exactly: with Σ ε_A instead, its round-off would add up over the steps into a pressure.
    trial.volumetric_log_strain = std::log(J);

    const double two_g = 2. * elastic_.shear;
    double dev_norm = 0.;
    for (const double e : trial.deviatoric_log_strains)
      dev_norm += e * e;
    const double three_g = 3. * elastic_.shear;
    const double own = two_g * three_g * dev_norm; // square of the trial state's von Mises stress
    const double q = std::sqrt(own + (shared != nullptr ? 2. * three_g * shared->energy : 0.));
    dev_norm = std::sqrt(dev_norm);

    delta_alpha = 0.;
    const double alpha_n = history_n.equivalent_plastic_strain;
    const double yield_stress = hardening_.stress(alpha_n);
    if (q > yield_stress * (1. + yield_slack)) {
      delta_alpha = q > yield_stress ? solve_consistency(hardening_, q, three_g, alpha_n) : 0.;
      const double reduction = three_g * delta_alpha / q;
      response.beta = 1. - reduction;
      const double gamma = three_g / (three_g + hardening_.slope(alpha_n + delta_alpha)) - reduction;
      if (dev_norm > 0.) {
        response.gamma = gamma * own / (q * q);
        for (unsigned int a = 0; a < 3; ++a)
          response.flow_direction[a] = trial.deviatoric_log_strains[a] / dev_norm;
      }
      if (shared != nullptr) {
        shared->share = response.beta;
        shared->slope = -gamma * three_g / (q * q);
        for (unsigned int a = 0; a < 3; ++a)
          shared->rate += shared->slope * two_g * trial.deviatoric_log_strains[a] *
                          dealii::outer_product(trial.directions[a], trial.directions[a]);
      }
    }
    for (unsigned int a = 0; a < 3; ++a)
      response.stress[a] = elastic_.bulk * trial.volumetric_log_strain +
                           two_g * response.beta * trial.deviatoric_log_strains[a];
    return true;
  }

  ElasticModuli elastic_;
  Hardening hardening_;
};

} // namespace billet

#endif
