// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_PLASTIC_H
#define BILLET_MATERIAL_PLASTIC_H

#include "billet/material/elastic.h"
#include "billet/material/hardening.h"
#include "billet/material/state_fields.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace billet {

/// Base of laws with F = F_e F_p; holds their history and flow stress.
class MultiplicativePlasticity {
public:
  struct History {
    /// C_p⁻¹.
    dealii::SymmetricTensor<2, 3> inverse_plastic_metric = dealii::unit_symmetric_tensor<3>();
    /// α.
    double equivalent_plastic_strain = 0.;
    FlowStress::State flow{};
  };
  using Moduli = SpatialModuli;
  static constexpr bool has_plasticity = true, is_rate_form = false;

  std::vector<StateField> fields() const {
    return {symmetric_field("inverse plastic metric"),
            {"equivalent plastic strain", 1},
            {flow_state_name, flow_->n_state()}};
  }
  /// Returns the state of the flow stress, see PointLaw::memory().
  std::vector<double> memory(const dealii::Tensor<2, 3> &, const History &history) const {
    return flow_->numbers_of(history.flow);
  }
  static void remember(const dealii::Tensor<2, 3> &, const std::vector<double> &memory, History &history) {
    std::copy(memory.begin(), memory.end(), history.flow.begin());
  }
  void store(const History &history, double *numbers) const {
    for (unsigned int i = 0; i < 6; ++i)
      numbers[i] = history.inverse_plastic_metric.access_raw_entry(i);
    numbers[6] = history.equivalent_plastic_strain;
    std::copy_n(history.flow.begin(), flow_->n_state(), numbers + 7);
  }
  History restore(const double *numbers) const {
    History history;
    for (unsigned int i = 0; i < 6; ++i)
      history.inverse_plastic_metric.access_raw_entry(i) = numbers[i];
    history.equivalent_plastic_strain = numbers[6];
    std::copy_n(numbers + 7, flow_->n_state(), history.flow.begin());
    return history;
  }

  static double equivalent_plastic_strain(const History &history) {
    return history.equivalent_plastic_strain;
  }
  double plastic_work(const History &history) const {
    return flow_->plastic_work(history.equivalent_plastic_strain, history.flow);
  }
  const std::shared_ptr<const FlowStress> &flow_stress() const { return flow_; }
  const ElasticModuli &elastic() const { return elastic_; }

protected:
  MultiplicativePlasticity(const ElasticModuli &elastic, std::shared_ptr<const FlowStress> flow)
      : elastic_(elastic), flow_(std::move(flow)) {}

  ElasticModuli elastic_;
  std::shared_ptr<const FlowStress> flow_;

  /// Returns the history for which F has this b̄_e: C_p⁻¹ = J^{2/3} F⁻¹ b̄_e F⁻ᵀ.
  static History history_of(const dealii::Tensor<2, 3> &F, const dealii::Tensor<2, 3> &b_e,
                            const double equivalent_plastic_strain) {
    const dealii::Tensor<2, 3> F_inverse = dealii::invert(F);
    return {std::pow(dealii::determinant(F), 2. / 3.) *
                dealii::symmetrize(F_inverse * b_e * dealii::transpose(F_inverse)),
            equivalent_plastic_strain,
            {}};
  }
};

/// Multiplicative J2 plasticity with Hencky elasticity: F = F_e F_p, Kirchhoff stress linear in the
/// elastic logarithmic strain. The yield condition |τ| = σ_y(α) is von Mises' in *Kirchhoff*
/// stress; associated flow is integrated by the exponential map. The return map is radial in
/// logarithmic principal space and exact (Simo & Hughes 1998, box 9.1; Eterovic & Bathe 1990).
class HenckyPlasticity : public MultiplicativePlasticity {
public:
  static constexpr bool has_symmetric_moduli = true, has_exact_dissipation = true;
  static constexpr LaneLaw lane_law = LaneLaw::hencky;

  HenckyPlasticity(const ElasticModuli &elastic, std::shared_ptr<const FlowStress> flow)
      : MultiplicativePlasticity(elastic, std::move(flow)) {}

  /// Computes the Kirchhoff stress `tau` [stress], the history at the end of the step and, if
  /// `moduli` is given, the consistent tangent. F is the deformation gradient at the end of the
  /// step, `history_n` the history at its start. `history_n` and `history` must not be the same
  /// object. Returns false if F is inadmissible (not finite, singular): the step must be cut.
  bool update(const dealii::Tensor<2, 3> &F, const History &history_n, History &history,
              dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli, const PointStep &step = {}) const;

  /// Returns the stored energy per reference volume [stress] at F with a history that belongs to F.
  double elastic_energy(const dealii::Tensor<2, 3> &F, const History &history) const;

  /// Returns the history for which `F` has a Kirchhoff stress with this deviator, which is below
  /// the yield stress: b̄_e = exp(dev τ/G).
  History find_history(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &deviator,
                       double equivalent_plastic_strain) const;

private:
  bool respond(const dealii::Tensor<2, 3> &F, const History &history_n, const PointStep &step,
               PrincipalElasticState &trial, PrincipalResponse &response, double &delta_alpha) const;
};

} // namespace billet

#endif
