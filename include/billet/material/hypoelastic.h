// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_HYPOELASTIC_H
#define BILLET_MATERIAL_HYPOELASTIC_H

#include "billet/material/plastic.h"

namespace billet {

/// Derivative of a stress by the velocity gradient, δτ = A : L with L = δF F⁻¹, where a law has no moduli in
/// the sense of SpatialModuli: rows τ11, τ22, τ33, τ12, τ13, τ23, columns L11, L12, L13, L21, ... L33
/// [stress].
using GradientModuli = std::array<std::array<double, 9>, 6>;

/// The increment of a step from F_n to F: ΔL = (F − F_n) F_m⁻¹ with F_m in the middle of the step, and the
/// rotation R = (1 − W/2)⁻¹ (1 + W/2), W = skew ΔL (Hughes & Winget 1980).
struct MidpointIncrement {
  dealii::Tensor<2, 3> gradient; ///< ΔL
  dealii::Tensor<1, 3> spin;     ///< axial vector of W
  dealii::Tensor<2, 3> rotation; ///< R
};

/// False where F is not finite or the middle of the step is inside out.
bool compute_increment(const dealii::Tensor<2, 3> &F_n, const dealii::Tensor<2, 3> &F,
                       MidpointIncrement &increment);

/// R s Rᵀ + 2 G dev sym ΔL.
dealii::SymmetricTensor<2, 3> compute_trial_deviator(const MidpointIncrement &increment, double shear,
                                                     const dealii::SymmetricTensor<2, 3> &deviator_n);

/// Derivative of the trial deviator by L. With ΔL' = (1 − ΔL/2) L (1 + ΔL/2), and R' Rᵀ the cross product
/// with (w' + ½ w × w')/(1 + w²/4), w the spin.
GradientModuli compute_trial_moduli(const MidpointIncrement &increment, double shear,
                                    const dealii::SymmetricTensor<2, 3> &deviator_n);

/// The paper's law: dev τ ← R dev τ Rᵀ + 2 G dev sym ΔL, returned radially to the yield surface, the pressure
/// total, κ ln J. Without plasticity (`Hardening` = std::monostate, say) use HypoelasticElasticity. A
/// rotation of the whole step turns the stress exactly, whatever its size; that the stress follows from rates
/// makes it depend on the step otherwise, and no energy is stored in a strict sense.
class HypoelasticElasticity {
public:
  struct History {
    dealii::Tensor<2, 3> F = dealii::unit_symmetric_tensor<3>(); ///< at the time of the stress
    dealii::SymmetricTensor<2, 3> deviator;                      ///< dev τ [stress]
  };
  using Moduli = GradientModuli;
  static constexpr bool has_plasticity = false, has_history = true, is_rate_form = true,
                        has_symmetric_moduli = false;

  explicit HypoelasticElasticity(const ElasticModuli &elastic) : elastic_(elastic) {}

  /// As HenckyPlasticity::update(), but for the volume ratio J of the pressure κ ln J, which is given: in an
  /// element with mean dilatation F is not that of F̄. `moduli`: of dev τ alone.
  bool update(const dealii::Tensor<2, 3> &F, const double J, const History &history_n, History &history,
              dealii::SymmetricTensor<2, 3> &tau, GradientModuli *moduli, double = 0.) const {
    MidpointIncrement increment;
    if (!(J > 0.) || !compute_increment(history_n.F, F, increment))
      return false;
    history.F = F;
    history.deviator = compute_trial_deviator(increment, elastic_.shear, history_n.deviator);
    tau = history.deviator + elastic_.bulk * std::log(J) * dealii::unit_symmetric_tensor<3>();
    if (moduli != nullptr)
      *moduli = compute_trial_moduli(increment, elastic_.shear, history_n.deviator);
    return true;
  }

  /// s : s/4G + ½ κ ln²J, with the history that belongs to J.
  double elastic_energy(const double J, const History &history) const {
    const double log_J = std::log(J);
    return history.deviator * history.deviator / (4. * elastic_.shear) + 0.5 * elastic_.bulk * log_J * log_J;
  }

  static History find_history(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &deviator,
                              double) {
    return {F, deviator};
  }

  static constexpr unsigned int n_history = 15;
  static void store(const History &history, double *numbers) {
    for (unsigned int i = 0; i < 9; ++i)
      numbers[i] = history.F[i / 3][i % 3];
    for (unsigned int i = 0; i < 6; ++i)
      numbers[9 + i] = history.deviator.access_raw_entry(i);
  }
  static History restore(const double *numbers) {
    History history;
    for (unsigned int i = 0; i < 9; ++i)
      history.F[i / 3][i % 3] = numbers[i];
    for (unsigned int i = 0; i < 6; ++i)
      history.deviator.access_raw_entry(i) = numbers[9 + i];
    return history;
  }

  static double plastic_work(const History &) { return 0.; }
  static double equivalent_plastic_strain(const History &) { return 0.; }

private:
  ElasticModuli elastic_;
};

/// The same with J2 plasticity: q − 3 G Δα = σ_y(α + Δα), the deviator scaled by β = σ_y/q. Yields in
/// Kirchhoff stress.
template <class Hardening> class HypoelasticPlasticity {
public:
  struct History : HypoelasticElasticity::History {
    double equivalent_plastic_strain = 0.; ///< α
  };
  using Moduli = GradientModuli;
  static constexpr bool has_plasticity = true, has_history = true, is_rate_form = true,
                        has_symmetric_moduli = false;

  HypoelasticPlasticity(const ElasticModuli &elastic, Hardening hardening)
      : elastic_law_(elastic), elastic_(elastic), hardening_(std::move(hardening)) {}

  /// See HypoelasticElasticity::update() and, for `yield_slack`, HenckyPlasticity::update(). With s the trial
  /// deviator, dev τ = β s: the moduli are β A + s ⊗ (k − β)/q ∂q, k = σ_y'/(3 G + σ_y'), ∂q = 3/2 s : A/q.
  bool update(const dealii::Tensor<2, 3> &F, const double J, const History &history_n, History &history,
              dealii::SymmetricTensor<2, 3> &tau, GradientModuli *moduli, const double yield_slack = 0.,
              SharedYield *shared = nullptr) const {
    if (!elastic_law_.update(F, J, history_n, history, tau, moduli))
      return false;
    const double alpha_n = history_n.equivalent_plastic_strain;
    history.equivalent_plastic_strain = alpha_n;
    const dealii::SymmetricTensor<2, 3> s = history.deviator;
    const double q =
        std::sqrt(1.5 * (s * s) + (shared != nullptr ? 6. * elastic_.shear * shared->energy : 0.));
    const double yield_stress = hardening_.stress(alpha_n);
    if (q > yield_stress * (1. + yield_slack)) {
      const double three_g = 3. * elastic_.shear;
      const double delta_alpha = q > yield_stress ? solve_consistency(hardening_, q, three_g, alpha_n) : 0.;
      const double reduction = three_g * delta_alpha / q, beta = 1. - reduction;
      history.equivalent_plastic_strain += delta_alpha;
      history.deviator = beta * s;
      tau -= reduction * s;
      const double slope = hardening_.slope(alpha_n + delta_alpha), k = slope / (three_g + slope);
      if (shared != nullptr) {
        shared->share = beta;
        shared->slope = three_g * (k - beta) / (q * q);
      }
      if (moduli != nullptr) {
        const double factor = 1.5 * (k - beta) / (q * q);
        for (unsigned int j = 0; j < 9; ++j) {
          double projection = 0.; // s : A
          for (unsigned int i = 0; i < 6; ++i)
            projection += (i < 3 ? 1. : 2.) * s.access_raw_entry(i) * (*moduli)[i][j];
          if (shared != nullptr)
            shared->rate[j / 3][j % 3] = factor * projection;
          for (unsigned int i = 0; i < 6; ++i)
            (*moduli)[i][j] = beta * (*moduli)[i][j] + factor * projection * s.access_raw_entry(i);
        }
      }
    }
    return true;
  }

  double elastic_energy(const double J, const History &history) const {
    return elastic_law_.elastic_energy(J, history);
  }

  static History find_history(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &deviator,
                              const double equivalent_plastic_strain) {
    return {{F, deviator}, equivalent_plastic_strain};
  }

  static constexpr unsigned int n_history = HypoelasticElasticity::n_history + 1;
  static void store(const History &history, double *numbers) {
    HypoelasticElasticity::store(history, numbers);
    numbers[n_history - 1] = history.equivalent_plastic_strain;
  }
  static History restore(const double *numbers) {
    return {HypoelasticElasticity::restore(numbers), numbers[n_history - 1]};
  }

  double plastic_work(const History &history) const {
    return hardening_.work(history.equivalent_plastic_strain);
  }
  static double equivalent_plastic_strain(const History &history) {
    return history.equivalent_plastic_strain;
  }

private:
  HypoelasticElasticity elastic_law_;
  ElasticModuli elastic_;
  Hardening hardening_;
};

} // namespace billet

#endif
