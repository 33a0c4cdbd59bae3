// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_HYPOELASTIC_H
#define BILLET_MATERIAL_HYPOELASTIC_H

#include "billet/material/plastic.h"

namespace billet {

/// Increment of a step from F_n to F: ΔL = (F − F_n) F_m⁻¹ with F_m at mid-step, and the rotation
/// R = (1 − W/2)⁻¹ (1 + W/2), W = skew ΔL (Hughes & Winget 1980).
struct MidpointIncrement {
  dealii::Tensor<2, 3> gradient; ///< ΔL
  dealii::Tensor<1, 3> spin;     ///< axial vector of W
  dealii::Tensor<2, 3> rotation; ///< R
};

/// Computes the increment. Returns false if F is not finite or the configuration at mid-step is
/// inverted.
bool compute_increment(const dealii::Tensor<2, 3> &F_n, const dealii::Tensor<2, 3> &F,
                       MidpointIncrement &increment);

/// Returns R s Rᵀ.
dealii::SymmetricTensor<2, 3> turn(const dealii::Tensor<2, 3> &R, const dealii::SymmetricTensor<2, 3> &s);

/// Returns R s Rᵀ + 2 G dev sym ΔL.
dealii::SymmetricTensor<2, 3> compute_trial_deviator(const MidpointIncrement &increment, double shear,
                                                     const dealii::SymmetricTensor<2, 3> &deviator_n);

/// Returns the derivative of the trial deviator with respect to L. It uses ΔL' = (1 − ΔL/2) L (1 +
/// ΔL/2); R' Rᵀ is the cross product with (w' + ½ w × w')/(1 + w²/4), w the spin.
GradientModuli compute_trial_moduli(const MidpointIncrement &increment, double shear,
                                    const dealii::SymmetricTensor<2, 3> &deviator_n);

/// Hypoelastic law of the paper, without plasticity: dev τ ← R dev τ Rᵀ + 2 G dev sym ΔL, with the
/// total pressure κ ln J. (The paper's law also returns the deviator radially to the yield
/// surface.) A rigid rotation in a step rotates the stress exactly, whatever its angle. Otherwise
/// the stress depends on the step size, since it follows from rates. In a strict sense no stored
/// energy exists.
class HypoelasticElasticity {
public:
  struct History {
    dealii::Tensor<2, 3> F = dealii::unit_symmetric_tensor<3>(); ///< at the time of the stress
    dealii::SymmetricTensor<2, 3> deviator;                      ///< dev τ [stress]
  };
  using Moduli = GradientModuli;
  static constexpr bool has_plasticity = false, is_rate_form = true, has_symmetric_moduli = false,
                        has_exact_dissipation = false;
  static constexpr LaneLaw lane_law = LaneLaw::hypoelastic;

  explicit HypoelasticElasticity(const ElasticModuli &elastic) : elastic_(elastic) {}

  /// Updates as HenckyPlasticity::update() does, but with a given volume ratio J for the pressure κ
  /// ln J. In an element with mean dilatation, J is not det F. The rows of `moduli` are those of
  /// dev τ alone.
  bool update(const dealii::Tensor<2, 3> &F, const double J, const History &history_n, History &history,
              dealii::SymmetricTensor<2, 3> &tau, GradientModuli *moduli, const PointStep & = {}) const {
    MidpointIncrement increment;
    if (!(J > 0.) || !compute_increment(history_n.F, F, increment))
      return false;
    history.F = F;
    history.deviator = compute_trial_deviator(increment, elastic_.shear, history_n.deviator);
    tau = history.deviator + elastic_.bulk * std::log(J) * dealii::unit_symmetric_tensor<3>();
    if (moduli != nullptr) {
      *moduli = compute_trial_moduli(increment, elastic_.shear, history_n.deviator);
      moduli->volumetric = elastic_.bulk;
    }
    return true;
  }

  /// Returns s : s/4G + ½ κ ln²J, with the history that belongs to J [stress].
  double elastic_energy(const double J, const History &history) const {
    const double log_J = std::log(J);
    return history.deviator * history.deviator / (4. * elastic_.shear) + 0.5 * elastic_.bulk * log_J * log_J;
  }

  static History find_history(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &deviator,
                              double) {
    return {F, deviator};
  }

  static std::vector<StateField> fields() {
    return {tensor_field("deformation gradient"), symmetric_field("deviator")};
  }
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
  const ElasticModuli &elastic() const { return elastic_; }
  double bound_stiffness(const dealii::SymmetricTensor<2, 3> &tau) const {
    return bound_elastic_stiffness(elastic_, tau);
  }
  double min_wave_stiffness(const Stretches &stretches) const {
    return min_wave_stiffness_of_rates(elastic_, stretches);
  }

private:
  ElasticModuli elastic_;
};

/// Hypoelastic law with J2 plasticity: q − 3 G Δα = σ_y(α + Δα), and the deviator is scaled by
/// β = σ_y/q. The yield condition is in Kirchhoff stress.
class HypoelasticPlasticity {
public:
  struct History : HypoelasticElasticity::History {
    double equivalent_plastic_strain = 0.; ///< α
    FlowStress::State flow{};
  };
  using Moduli = GradientModuli;
  static constexpr bool has_plasticity = true, is_rate_form = true, has_symmetric_moduli = false,
                        has_exact_dissipation = false;
  static constexpr LaneLaw lane_law = LaneLaw::hypoelastic;

  HypoelasticPlasticity(const ElasticModuli &elastic, std::shared_ptr<const FlowStress> flow)
      : elastic_law_(elastic), elastic_(elastic), flow_(std::move(flow)) {}

  /// Updates as HypoelasticElasticity::update() does. With s the trial deviator, dev τ = β s: the
  /// moduli are β A + s ⊗ (k − β)/q ∂q, k = σ_y'/(3 G + σ_y'), ∂q = 3/2 s : A/q.
  bool update(const dealii::Tensor<2, 3> &F, double J, const History &history_n, History &history,
              dealii::SymmetricTensor<2, 3> &tau, GradientModuli *moduli, const PointStep &step = {}) const;

  double elastic_energy(const double J, const History &history) const {
    return elastic_law_.elastic_energy(J, history);
  }

  static History find_history(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &deviator,
                              const double equivalent_plastic_strain) {
    return {{F, deviator}, equivalent_plastic_strain, {}};
  }

  std::vector<StateField> fields() const {
    std::vector<StateField> result = HypoelasticElasticity::fields();
    result.push_back({"equivalent plastic strain", 1});
    result.push_back({flow_state_name, flow_->n_state()});
    return result;
  }
  /// Returns the state of the flow stress, see PointLaw::memory().
  std::vector<double> memory(const dealii::Tensor<2, 3> &, const History &history) const {
    return flow_->numbers_of(history.flow);
  }
  static void remember(const dealii::Tensor<2, 3> &, const std::vector<double> &memory, History &history) {
    std::copy(memory.begin(), memory.end(), history.flow.begin());
  }
  void store(const History &history, double *numbers) const {
    HypoelasticElasticity::store(history, numbers);
    numbers[15] = history.equivalent_plastic_strain;
    std::copy_n(history.flow.begin(), flow_->n_state(), numbers + 16);
  }
  History restore(const double *numbers) const {
    History history{HypoelasticElasticity::restore(numbers), numbers[15], {}};
    std::copy_n(numbers + 16, flow_->n_state(), history.flow.begin());
    return history;
  }

  double plastic_work(const History &history) const {
    return flow_->plastic_work(history.equivalent_plastic_strain, history.flow);
  }
  static double equivalent_plastic_strain(const History &history) {
    return history.equivalent_plastic_strain;
  }
  const std::shared_ptr<const FlowStress> &flow_stress() const { return flow_; }
  const ElasticModuli &elastic() const { return elastic_; }

private:
  HypoelasticElasticity elastic_law_;
  ElasticModuli elastic_;
  std::shared_ptr<const FlowStress> flow_;
};

} // namespace billet

#endif
