// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_LAW_ADAPTER_H
#define BILLET_MATERIAL_LAW_ADAPTER_H

#include "billet/material/point_law.h"

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace billet {

/// Which of its optional members a value type has.
namespace adapter {

template <class L> constexpr auto has_memory(int) -> decltype(static_cast<void>(&L::memory), bool()) {
  return true;
}
template <class L> constexpr bool has_memory(long) { return false; }

template <class L> constexpr auto has_flow_slope(int) -> decltype(static_cast<void>(&L::flow_slope), bool()) {
  return true;
}
template <class L> constexpr bool has_flow_slope(long) { return false; }

template <class L>
constexpr auto has_own_bound(int) -> decltype(static_cast<void>(&L::bound_stiffness), bool()) {
  return true;
}
template <class L> constexpr bool has_own_bound(long) { return false; }

template <class L> constexpr auto has_directions(int) -> decltype(static_cast<void>(&L::directions), bool()) {
  return true;
}
template <class L> constexpr bool has_directions(long) { return false; }

template <class L> constexpr auto finds_temperature(int) -> decltype(L::depends_on_temperature) {
  return L::depends_on_temperature;
}
template <class L> constexpr bool finds_temperature(long) { return false; }

} // namespace adapter

/// PointLaw made from a value type such as HenckyElasticity. It has
///   Moduli, has_plasticity, is_rate_form, has_symmetric_moduli, has_exact_dissipation
///   History                       its state, with default values of the undeformed point
///   fields(), store(), restore()  names of that state, and it as numbers; none if it is empty
///   update(), elastic_energy(), plastic_work(), equivalent_plastic_strain(), elastic()
///   find_history()                unless History is empty
///   memory(), remember()          if History has more than stress and equivalent plastic strain
///   min_wave_stiffness()          of laws without plasticity
///   lane_law                      if the explicit kernels have the law
///   depends_on_temperature        true, if it reads PointStep::temperature
///   flow_slope()                  if the law may soften
///   bound_stiffness(tau)          if PointLaw's is not the law's; else moduli bound elastic laws
///   flow_stress()                 with plasticity
///   directions()                  what summary() adds about the material's directions, if any
template <class Law> class LawAdapter final : public LawWithModuli<typename Law::Moduli> {
public:
  using History = typename Law::History;
  static constexpr bool has_history = !std::is_empty_v<History>;

  LawAdapter(std::string name, Law law) : name_(std::move(name)), law_(std::move(law)) {
    for (const StateField &field : fields())
      n_state_ += field.n_components;
  }

  std::string name() const override { return name_; }
  std::string summary() const override {
    if constexpr (adapter::has_directions<Law>(0))
      return PointLaw::summary() + law_.directions();
    else
      return PointLaw::summary();
  }
  const ElasticModuli &elastic() const override { return law_.elastic(); }
  double bound_stiffness(const dealii::SymmetricTensor<2, 3> &tau) const override {
    if constexpr (adapter::has_own_bound<Law>(0))
      return law_.bound_stiffness(tau);
    else
      return PointLaw::bound_stiffness(tau);
  }
  bool has_bound_of_stiffness() const override {
    return Law::has_plasticity || adapter::has_own_bound<Law>(0);
  }
  std::shared_ptr<const FlowStress> shared_flow_stress() const override {
    if constexpr (Law::has_plasticity)
      return law_.flow_stress();
    else
      return nullptr;
  }
  bool depends_on_temperature() const override { return adapter::finds_temperature<Law>(0); }
  bool has_symmetric_moduli() const override { return Law::has_symmetric_moduli; }
  bool is_rate_form() const override { return Law::is_rate_form; }
  bool has_exact_dissipation() const override { return Law::has_exact_dissipation; }

  std::vector<StateField> fields() const override {
    if constexpr (has_history)
      return law_.fields();
    else
      return {};
  }
  std::size_t n_state() const override { return n_state_; }
  void initialize([[maybe_unused]] double *state) const override {
    if constexpr (has_history)
      law_.store(History(), state);
  }

  bool update(const dealii::Tensor<2, 3> &F, [[maybe_unused]] const double J, const PointStep &step,
              const double *state_n, [[maybe_unused]] double *state, dealii::SymmetricTensor<2, 3> &tau,
              typename Law::Moduli *moduli) const override {
    const History history_n = restore(state_n);
    History history;
    bool is_admissible = false;
    if constexpr (Law::is_rate_form)
      is_admissible = law_.update(F, J, history_n, history, tau, moduli, step);
    else
      is_admissible = law_.update(F, history_n, history, tau, moduli, step);
    if constexpr (has_history)
      law_.store(history, state);
    return is_admissible;
  }

  double stored_energy([[maybe_unused]] const dealii::Tensor<2, 3> &F, [[maybe_unused]] const double J,
                       const double *state) const override {
    if constexpr (Law::is_rate_form)
      return law_.elastic_energy(J, restore(state));
    else
      return law_.elastic_energy(F, restore(state));
  }
  double dissipated_energy(const double *state) const override { return law_.plastic_work(restore(state)); }
  double equivalent_plastic_strain(const double *state) const override {
    return law_.equivalent_plastic_strain(restore(state));
  }

  void set_stress([[maybe_unused]] const dealii::Tensor<2, 3> &F,
                  [[maybe_unused]] const dealii::SymmetricTensor<2, 3> &deviator,
                  [[maybe_unused]] const double equivalent_plastic_strain,
                  [[maybe_unused]] double *state) const override {
    if constexpr (has_history)
      law_.store(law_.find_history(F, deviator, equivalent_plastic_strain), state);
  }

  std::vector<double> memory([[maybe_unused]] const dealii::Tensor<2, 3> &F,
                             [[maybe_unused]] const double *state) const override {
    if constexpr (adapter::has_memory<Law>(0))
      return law_.memory(F, restore(state));
    else
      return {};
  }
  void remember([[maybe_unused]] const dealii::Tensor<2, 3> &F,
                [[maybe_unused]] const std::vector<double> &memory,
                [[maybe_unused]] double *state) const override {
    if constexpr (adapter::has_memory<Law>(0)) {
      History history = restore(state);
      law_.remember(F, memory, history);
      law_.store(history, state);
    }
  }

  std::optional<double>
  min_wave_stiffness([[maybe_unused]] const std::array<double, 3> &stretches) const override {
    if constexpr (Law::has_plasticity)
      return {};
    else
      return law_.min_wave_stiffness(stretches);
  }

  std::optional<double> flow_slope([[maybe_unused]] const double *state,
                                   [[maybe_unused]] const double temperature) const override {
    if constexpr (adapter::has_flow_slope<Law>(0))
      return law_.flow_slope(restore(state), temperature);
    else
      return {};
  }

  std::optional<LaneLaw> lane_law() const override { return find_lane_law<Law>(0); }

private:
  template <class L> static auto find_lane_law(int) -> std::optional<std::decay_t<decltype(L::lane_law)>> {
    return L::lane_law;
  }
  template <class L> static std::optional<LaneLaw> find_lane_law(long) { return {}; }

  History restore([[maybe_unused]] const double *state) const {
    if constexpr (has_history)
      return law_.restore(state);
    else
      return {};
  }

  std::string name_;
  Law law_;
  std::size_t n_state_ = 0;
};

} // namespace billet

#endif
