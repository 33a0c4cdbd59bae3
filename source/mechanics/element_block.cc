// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/element_block.h"

#include "billet/material/plastic.h"

#include <type_traits>

namespace billet {

namespace {

template <class Law> class MeanDilatationBlock final : public ElementBlock {
public:
  explicit MeanDilatationBlock(Law law) : law_(std::move(law)) {}

  bool initialize(const std::vector<ElementVectors> &positions, std::size_t &offender) override {
    elements_.resize(positions.size());
    for (offender = 0; offender < positions.size(); ++offender)
      if (!compute_reference_element(positions[offender], elements_[offender]))
        return false;
    history_n_.assign(n_histories(), PointHistories{});
    history_ = history_n_;
    return true;
  }

  std::size_t size() const override { return elements_.size(); }

  bool evaluate(const std::size_t element, const ElementVectors &displacements, ElementVectors &force,
                ElementMatrix *matrix, const double yield_slack) override {
    MeanDilatationKinematics kinematics;
    if (!compute_kinematics(elements_[element], displacements, kinematics))
      return false;
    std::array<dealii::SymmetricTensor<2, 3>, n_element_points> tau;
    std::array<SpatialModuli, n_element_points> moduli;
    for (unsigned int q = 0; q < n_element_points; ++q)
      if (!law_.update(kinematics.F_bar[q], history_at(history_n_, element)[q],
                       history_at(history_, element)[q], tau[q], matrix != nullptr ? &moduli[q] : nullptr,
                       yield_slack))
        return false;
    force.fill(0.);
    add_internal_force(elements_[element], kinematics, tau, force);
    if (matrix != nullptr)
      compute_internal_tangent(elements_[element], kinematics, tau, moduli, *matrix);
    return true;
  }

  void commit() override { history_n_ = history_; }

  ElementSummary summarize(const std::size_t element, const ElementVectors &displacements) const override {
    ElementSummary summary;
    MeanDilatationKinematics kinematics;
    if (!compute_kinematics(elements_[element], displacements, kinematics))
      return summary;
    double reference_volume = 0.;
    const PointHistories &histories = history_at(history_n_, element);
    for (unsigned int q = 0; q < n_element_points; ++q) {
      const auto &history = histories[q];
      const double w = elements_[element].volumes[q];
      typename Law::History ignored;
      dealii::SymmetricTensor<2, 3> tau;
      if (!law_.update(kinematics.F_bar[q], history, ignored, tau, nullptr))
        continue;
      summary.cauchy_stress += w * tau; // σ J w = τ w
      summary.equivalent_plastic_strain += w * law_.equivalent_plastic_strain(history);
      summary.elastic_energy += w * law_.elastic_energy(kinematics.F_bar[q], history);
      summary.plastic_work += w * law_.plastic_work(history);
      reference_volume += w;
    }
    summary.cauchy_stress /= kinematics.current_volume;
    summary.equivalent_plastic_strain /= reference_volume;
    return summary;
  }

  std::size_t history_size() const override {
    return Law::has_plasticity ? 2 * sizeof(PointHistories) / sizeof(double) : 0;
  }

  std::size_t state_size() const override {
    return Law::has_plasticity ? n_element_points * Law::n_history : 0;
  }

  void get_state(const std::size_t element, double *state) const override {
    if constexpr (Law::has_plasticity)
      for (const auto &history : history_at(history_n_, element)) {
        Law::store(history, state);
        state += Law::n_history;
      }
  }

  void set_state(const std::size_t element, const double *state) override {
    if constexpr (Law::has_plasticity) {
      for (auto &history : history_at(history_n_, element)) {
        history = Law::restore(state);
        state += Law::n_history;
      }
      history_at(history_, element) = history_at(history_n_, element);
    }
  }

  ElementStress compute_stress(const std::size_t element,
                               const ElementVectors &displacements) const override {
    ElementStress stress;
    MeanDilatationKinematics kinematics;
    if (!compute_kinematics(elements_[element], displacements, kinematics))
      return stress;
    for (unsigned int q = 0; q < n_element_points; ++q) {
      typename Law::History ignored;
      const auto &history = history_at(history_n_, element)[q];
      if (law_.update(kinematics.F_bar[q], history, ignored, stress[q].deviator, nullptr))
        stress[q].deviator = dealii::deviator(stress[q].deviator);
      stress[q].equivalent_plastic_strain = law_.equivalent_plastic_strain(history);
    }
    return stress;
  }

  void set_stress(const std::size_t element, const ElementVectors &displacements,
                  const ElementStress &stress) override {
    if constexpr (Law::has_plasticity) {
      MeanDilatationKinematics kinematics;
      if (!compute_kinematics(elements_[element], displacements, kinematics))
        return;
      for (unsigned int q = 0; q < n_element_points; ++q)
        history_at(history_n_, element)[q] =
            law_.find_history(kinematics.F_bar[q], stress[q].deviator, stress[q].equivalent_plastic_strain);
      history_at(history_, element) = history_at(history_n_, element);
    }
  }

private:
  using PointHistories = std::array<typename Law::History, n_element_points>;

  // A law without history keeps a single dummy for all elements.
  std::size_t n_histories() const { return Law::has_plasticity ? elements_.size() : 1; }
  static PointHistories &history_at(std::vector<PointHistories> &histories, const std::size_t element) {
    return histories[Law::has_plasticity ? element : 0];
  }
  static const PointHistories &history_at(const std::vector<PointHistories> &histories,
                                          const std::size_t element) {
    return histories[Law::has_plasticity ? element : 0];
  }

  Law law_;
  std::vector<ReferenceElement> elements_;
  std::vector<PointHistories> history_n_, history_;
};

} // namespace

std::unique_ptr<ElementBlock> make_element_block(const MaterialLaw &material) {
  return std::visit(
      [&material](const auto &hardening) -> std::unique_ptr<ElementBlock> {
        using Hardening = std::decay_t<decltype(hardening)>;
        if constexpr (std::is_same_v<Hardening, std::monostate>)
          return std::make_unique<MeanDilatationBlock<HenckyElasticity>>(HenckyElasticity(material.elastic));
        else
          return std::make_unique<MeanDilatationBlock<HenckyPlasticity<Hardening>>>(
              HenckyPlasticity<Hardening>(material.elastic, hardening));
      },
      material.hardening);
}

} // namespace billet
