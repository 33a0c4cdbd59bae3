// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_FLOW_RULE_PLASTIC_H
#define BILLET_MATERIAL_FLOW_RULE_PLASTIC_H

#include "billet/material/flow_rule.h"
#include "billet/material/log_map.h"
#include "billet/material/plastic.h"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace billet {

/// Multiplicative plasticity with Hencky elasticity, F = F_e F_p, and a flow rule with directions:
/// backstress, Hill's yield function or both (doc/theory.md, "Flow rules"). V_e is the elastic
/// stretch, and C_j⁻¹ are the Lagrangian metrics of the history. A step solves
///   ½ ln(V_e⁻¹ F C_p⁻¹ Fᵀ V_e⁻¹) = Δα H ξ/Q,   Q = √(ξ : H : ξ) = σ_y(α + Δα),                (H5)
///   ξ = 2G dev ln V_e − Σ ⅔ C_j κ_j,                                                          (H3)
/// for ln V_e and Δα, by Newton's method to round-off. Without backstress and anisotropy it is
/// HenckyPlasticity. `has_directions`: whether the moduli are unsymmetric; `is_thermal`: whether
/// the flow rule has a thermal factor.
template <bool has_directions, bool is_thermal> class FlowRulePlasticity {
public:
  struct History {
    /// C_p⁻¹.
    dealii::SymmetricTensor<2, 3> inverse_plastic_metric = dealii::unit_symmetric_tensor<3>();
    /// α.
    double equivalent_plastic_strain = 0.;
    FlowStress::State flow{};
    /// Energy beyond the flow stress' work without a thermal factor [stress].
    double dissipated = 0.;
    double temperature_rise = 0.; ///< by dissipation [temperature]
    /// Kirchhoff's, in space, at the end of the step [stress].
    dealii::SymmetricTensor<2, 3> backstress;
    /// Metrics C_j⁻¹ of the terms.
    std::array<dealii::SymmetricTensor<2, 3>, FlowRule::max_terms> inverse_metrics = undeformed_metrics();

    static std::array<dealii::SymmetricTensor<2, 3>, FlowRule::max_terms> undeformed_metrics() {
      std::array<dealii::SymmetricTensor<2, 3>, FlowRule::max_terms> metrics;
      metrics.fill(dealii::unit_symmetric_tensor<3>());
      return metrics;
    }
  };
  using Moduli = SpatialModuli;
  static constexpr bool has_plasticity = true, is_rate_form = false, has_symmetric_moduli = !has_directions,
                        has_exact_dissipation = true, depends_on_temperature = is_thermal;

  /// Throws std::invalid_argument if there are more than FlowRule::max_terms terms.
  FlowRulePlasticity(const ElasticModuli &elastic, SharedFlow flow, FlowRule rule);

  /// Updates as HenckyPlasticity::update() does. It also returns false if the iteration does not
  /// converge.
  bool update(const dealii::Tensor<2, 3> &F, const History &history_n, History &history,
              dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli, const PointStep &step = {}) const;

  double elastic_energy(const dealii::Tensor<2, 3> &F, const History &history) const;
  History find_history(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &deviator,
                       double equivalent_plastic_strain) const;

  /// Returns what PointLaw::memory() says: state of the flow stress, dissipation, temperature rise,
  /// and κ_j in space.
  std::vector<double> memory(const dealii::Tensor<2, 3> &F, const History &history) const;
  void remember(const dealii::Tensor<2, 3> &F, const std::vector<double> &memory, History &history) const;

  std::vector<StateField> fields() const;
  std::string directions() const {
    return rule_.anisotropy != nullptr ? ", Hill's anisotropy in " + rule_.anisotropy->axes.description()
                                       : "";
  }
  void store(const History &history, double *numbers) const;
  History restore(const double *numbers) const;

  static double equivalent_plastic_strain(const History &history) {
    return history.equivalent_plastic_strain;
  }
  /// Returns what PointLaw::flow_slope() says; nothing without a thermal factor.
  std::optional<double> flow_slope(const History &history, double temperature) const;
  double plastic_work(const History &history) const {
    return flow_->plastic_work(history.equivalent_plastic_strain, history.flow) + history.dissipated;
  }
  const SharedFlow &flow_stress() const { return described_flow_; }
  const ElasticModuli &elastic() const { return elastic_; }

private:
  struct Trial;
  class Return;

  bool prepare(const dealii::Tensor<2, 3> &F, const History &history_n, Trial &trial) const;

  ElasticModuli elastic_;
  SharedFlow flow_, described_flow_;
  FlowRule rule_;
  Matrix6 yield_; ///< H in Kelvin's notation
};

extern template class FlowRulePlasticity<false, true>;
extern template class FlowRulePlasticity<true, false>;
extern template class FlowRulePlasticity<true, true>;

} // namespace billet

#endif
