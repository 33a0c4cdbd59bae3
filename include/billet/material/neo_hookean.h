// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_NEO_HOOKEAN_H
#define BILLET_MATERIAL_NEO_HOOKEAN_H

#include "billet/material/plastic.h"

namespace billet {

/// Returns the x for which det(X + x 1) = 1, X traceless: the largest root of x³ − i_2 x + i_3 − 1
/// with i_2 = X:X/2, i_3 = det X, for which X + x 1 is positive definite.
double complete_unimodular(const dealii::SymmetricTensor<2, 3> &X);

/// State of the neo-Hookean laws at F and C_p⁻¹: b̄_e = J^{-2/3} F C_p⁻¹ Fᵀ.
struct IsochoricState {
  double J;
  double mean;                            ///< tr b̄_e / 3
  dealii::SymmetricTensor<2, 3> deviator; ///< deviator of b̄_e
};

/// Computes the state. Returns false if F is not finite or det F ≤ 0.
bool compute_isochoric_state(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &metric,
                             IsochoricState &state);

/// Returns the stored energy per reference volume, ½ κ ln²J + ½ G (tr b̄_e − 3) [stress], given det
/// b̄_e = 1. With x = tr b̄_e / 3 and the invariants of dev b̄_e, x³ − 1 = i_2 x − i_3: this avoids
/// the difference of numbers close to 1.
double compute_elastic_energy(const ElasticModuli &elastic, const IsochoricState &state);

/// Overwrites `moduli` with those of τ = κ ln J 1 + β s, s = G dev b̄_e:
///   c = κ 1⊗1 − 2 κ ln J I + β [2 μ̄ (I − 1⊗1/3) − ⅔ (1⊗s + s⊗1)] + s ⊗ ∂β,   μ̄ = G tr b̄_e/3.
/// ∂β : d is the rate of β; doc/theory.md has ∂β. Source: Simo & Hughes 1998, box 9.2, before it is
/// symmetrised.
void compute_neo_hookean_moduli(const ElasticModuli &elastic, const IsochoricState &state, double beta,
                                const dealii::SymmetricTensor<2, 3> &beta_rate, SpatialModuli &moduli);

/// Compressible neo-Hookean elasticity, ψ = ½ κ ln²J + ½ G (tr b̄ − 3). No history.
class NeoHookeanElasticity {
public:
  struct History {};
  using Moduli = SpatialModuli;
  static constexpr bool has_plasticity = false, is_rate_form = false, has_symmetric_moduli = true,
                        has_exact_dissipation = true;
  static constexpr LaneLaw lane_law = LaneLaw::neo_hookean;

  explicit NeoHookeanElasticity(const ElasticModuli &elastic) : elastic_(elastic) {}

  /// Updates as HenckyPlasticity::update() does.
  bool update(const dealii::Tensor<2, 3> &F, const History &, History &, dealii::SymmetricTensor<2, 3> &tau,
              SpatialModuli *moduli, const PointStep & = {}) const {
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
  const ElasticModuli &elastic() const { return elastic_; }
  double bound_stiffness(const dealii::SymmetricTensor<2, 3> &tau) const {
    return bound_elastic_stiffness(elastic_, tau);
  }
  double min_wave_stiffness(const Stretches &stretches) const {
    return billet::min_wave_stiffness(*this, elastic_.shear, stretches);
  }

private:
  ElasticModuli elastic_;
};

/// Simo's multiplicative J2 plasticity with neo-Hookean elasticity (Simo & Hughes 1998, box 9.1),
/// without an eigenproblem: the return is q − G tr b̄_e Δα = σ_y, radial in dev b̄_e. Box 9.1
/// preserves tr b̄_e; this return map preserves det b̄_e = 1. Plastic flow is therefore isochoric,
/// and a state at rest does not change. The yield condition is in Kirchhoff stress.
class NeoHookeanPlasticity : public MultiplicativePlasticity {
public:
  static constexpr bool has_symmetric_moduli = false, has_exact_dissipation = false;
  static constexpr LaneLaw lane_law = LaneLaw::neo_hookean;

  NeoHookeanPlasticity(const ElasticModuli &elastic, std::shared_ptr<const FlowStress> flow)
      : MultiplicativePlasticity(elastic, std::move(flow)) {}

  /// Updates as HenckyPlasticity::update() does. The moduli are exact. At a yielding point their
  /// term s ⊗ ∂β is unsymmetric, by the order of the elastic strain.
  bool update(const dealii::Tensor<2, 3> &F, const History &history_n, History &history,
              dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli, const PointStep &step = {}) const;

  double elastic_energy(const dealii::Tensor<2, 3> &F, const History &history) const;

  /// Returns the history as HenckyPlasticity::find_history() does; here b̄_e = dev τ/G + x 1, det
  /// b̄_e = 1.
  History find_history(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &deviator,
                       double equivalent_plastic_strain) const;
};

} // namespace billet

#endif
