// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_NEO_HOOKEAN_H
#define BILLET_MATERIAL_NEO_HOOKEAN_H

#include "billet/material/plastic.h"

namespace billet {

/// The x for which det(X + x 1) = 1, X traceless: the largest root of x³ − i_2 x + i_3 − 1 with i_2 = X:X/2,
/// i_3 = det X, for which X + x 1 is positive definite.
double complete_unimodular(const dealii::SymmetricTensor<2, 3> &X);

/// What the neo-Hookean laws know at F and C_p⁻¹: b̄_e = J^{-2/3} F C_p⁻¹ Fᵀ.
struct IsochoricState {
  double J;
  double mean;                            ///< tr b̄_e / 3
  dealii::SymmetricTensor<2, 3> deviator; ///< of b̄_e
};

/// False where F is not finite or det F ≤ 0.
bool compute_isochoric_state(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &metric,
                             IsochoricState &state);

/// Stored energy per reference volume, ½ κ ln²J + ½ G (tr b̄_e − 3) [stress], where det b̄_e = 1: with
/// x = tr b̄_e / 3 and the invariants of dev b̄_e, x³ − 1 = i_2 x − i_3, without the difference of numbers
/// next to 1.
double compute_elastic_energy(const ElasticModuli &elastic, const IsochoricState &state);

/// Overwrites `moduli` with those of τ = κ ln J 1 + β s, s = G dev b̄_e:
///   c = κ 1⊗1 − 2 κ ln J I + β [2 μ̄ (I − 1⊗1/3) − ⅔ (1⊗s + s⊗1)] + s ⊗ ∂β,   μ̄ = G tr b̄_e/3,
/// ∂β : d the rate of β (Simo & Hughes 1998, box 9.2, before it is symmetrised; doc/theory.md has ∂β).
void compute_neo_hookean_moduli(const ElasticModuli &elastic, const IsochoricState &state, double beta,
                                const dealii::SymmetricTensor<2, 3> &beta_rate, SpatialModuli &moduli);

/// Compressible neo-Hookean elasticity, ψ = ½ κ ln²J + ½ G (tr b̄ − 3). No history.
class NeoHookeanElasticity {
public:
  struct History {};
  using Moduli = SpatialModuli;
  static constexpr bool has_plasticity = false, has_history = false, is_rate_form = false,
                        has_symmetric_moduli = true;
  static constexpr unsigned int n_history = 0;

  explicit NeoHookeanElasticity(const ElasticModuli &elastic) : elastic_(elastic) {}

  /// See HenckyPlasticity::update().
  bool update(const dealii::Tensor<2, 3> &F, const History &, History &, dealii::SymmetricTensor<2, 3> &tau,
              SpatialModuli *moduli, double = 0.) const {
    IsochoricState state;
    if (!compute_isochoric_state(F, dealii::unit_symmetric_tensor<3>(), state))
      return false;
    tau = elastic_.shear * state.deviator +
          elastic_.bulk * std::log(state.J) * dealii::unit_symmetric_tensor<3>();
    if (moduli != nullptr)
      compute_neo_hookean_moduli(elastic_, state, 1., {}, *moduli);
    return true;
  }

  double elastic_energy(const dealii::Tensor<2, 3> &F, const History &) const {
    IsochoricState state;
    return compute_isochoric_state(F, dealii::unit_symmetric_tensor<3>(), state)
               ? compute_elastic_energy(elastic_, state)
               : 0.;
  }

  static double plastic_work(const History &) { return 0.; }
  static double equivalent_plastic_strain(const History &) { return 0.; }

private:
  ElasticModuli elastic_;
};

/// Simo's multiplicative J2 plasticity with neo-Hookean elasticity (Simo & Hughes 1998, box 9.1), without an
/// eigenproblem: the return is q − G tr b̄_e Δα = σ_y, radial in dev b̄_e. Where the box keeps tr b̄_e the
/// return here keeps det b̄_e = 1, so that plastic flow has no volume and a state that stands still stays.
/// Yields in Kirchhoff stress.
template <class Hardening> class NeoHookeanPlasticity : public MultiplicativePlasticity {
public:
  using Moduli = SpatialModuli;
  static constexpr bool has_plasticity = true, has_history = true, is_rate_form = false,
                        has_symmetric_moduli = false;

  NeoHookeanPlasticity(const ElasticModuli &elastic, Hardening hardening)
      : elastic_(elastic), hardening_(std::move(hardening)) {}

  /// See HenckyPlasticity::update(). The moduli are exact, and unsymmetric by the order of the elastic strain
  /// where the point yields: their s ⊗ ∂β is.
  bool update(const dealii::Tensor<2, 3> &F, const History &history_n, History &history,
              dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli, const double yield_slack = 0.,
              SharedYield *shared = nullptr) const {
    IsochoricState trial;
    if (!compute_isochoric_state(F, history_n.inverse_plastic_metric, trial))
      return false;
    const dealii::SymmetricTensor<2, 3> s = elastic_.shear * trial.deviator;
    const double alpha_n = history_n.equivalent_plastic_strain;
    const double q =
        std::sqrt(1.5 * (s * s) + (shared != nullptr ? 6. * elastic_.shear * shared->energy : 0.));
    const double yield_stress = hardening_.stress(alpha_n);
    double beta = 1., delta_alpha = 0.;
    dealii::SymmetricTensor<2, 3> beta_rate;
    if (q > yield_stress * (1. + yield_slack)) {
      const double m = 3. * elastic_.shear * trial.mean;
      delta_alpha = q > yield_stress ? solve_consistency(hardening_, q, m, alpha_n) : 0.;
      beta = 1. - m * delta_alpha / q;
      const double slope = hardening_.slope(alpha_n + delta_alpha), k = slope / (m + slope);
      if (moduli != nullptr)
        beta_rate = compute_beta_rate(s, q, m, beta, k, delta_alpha);
      if (shared != nullptr) {
        shared->share = beta;
        shared->slope = 3. * elastic_.shear * (k - beta) / (q * q);
        shared->rate = beta_rate;
      }
    }
    tau = beta * s + elastic_.bulk * std::log(trial.J) * dealii::unit_symmetric_tensor<3>();
    if (moduli != nullptr)
      compute_neo_hookean_moduli(elastic_, trial, beta, beta_rate, *moduli);

    history = history_n;
    if (delta_alpha > 0.) {
      history.equivalent_plastic_strain += delta_alpha;
      // F⁻¹ b̄_e F⁻ᵀ with b̄_e = β dev b̄_trial + x 1: a multiple of C⁻¹ is all that is added.
      const double x = complete_unimodular(beta * trial.deviator);
      const dealii::SymmetricTensor<2, 3> C_inverse =
          dealii::invert(dealii::symmetrize(dealii::transpose(F) * F));
      history.inverse_plastic_metric = beta * history_n.inverse_plastic_metric +
                                       (x - beta * trial.mean) * std::cbrt(trial.J * trial.J) * C_inverse;
    }
    return true;
  }

  double elastic_energy(const dealii::Tensor<2, 3> &F, const History &history) const {
    IsochoricState state;
    return compute_isochoric_state(F, history.inverse_plastic_metric, state)
               ? compute_elastic_energy(elastic_, state)
               : 0.;
  }

  /// See HenckyPlasticity::find_history(); b̄_e = dev τ/G + x 1, det b̄_e = 1.
  History find_history(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &deviator,
                       const double equivalent_plastic_strain) const {
    const dealii::SymmetricTensor<2, 3> X = deviator / elastic_.shear;
    return history_of(F, X + complete_unimodular(X) * dealii::unit_symmetric_tensor<3>(),
                      equivalent_plastic_strain);
  }

  double plastic_work(const History &history) const {
    return hardening_.work(history.equivalent_plastic_strain);
  }

private:
  /// ∂β with β = σ_y(α + Δα)/q, q − m Δα = σ_y(α + Δα), k = σ_y'/(m + σ_y'), and the rates of q and m = 3 μ̄:
  ///   q q̇ = (m s + 3 dev s²) : d,   ṁ = 2 s : d.
  static dealii::SymmetricTensor<2, 3> compute_beta_rate(const dealii::SymmetricTensor<2, 3> &s,
                                                         const double q, const double m, const double beta,
                                                         const double k, const double delta_alpha) {
    const dealii::Tensor<2, 3> matrix = s;
    return ((k - beta) / q * (m * s + 3. * dealii::deviator(dealii::symmetrize(matrix * matrix))) -
            (2. * k * delta_alpha) * s) /
           q;
  }

  ElasticModuli elastic_;
  Hardening hardening_;
};

} // namespace billet

#endif
