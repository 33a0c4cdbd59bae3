// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/oriented_law.h"

#include <stdexcept>
#include <utility>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

namespace {

constexpr std::size_t n_axes = 9; ///< numbers of Q, which follow the state of the law

class OrientedLaw final : public SpatialLaw {
public:
  OrientedLaw(SharedLaw law, const Axes &axes)
      : shared_law_(std::move(law)), law_(dynamic_cast<const SpatialLaw &>(*shared_law_)), axes_(axes),
        n_inner_(law_.n_state()) {}

  std::string name() const override { return law_.name(); }
  std::string description() const override { return law_.description() + ", in " + axes_.description(); }
  std::string summary() const override { return SpatialLaw::summary() + ", in " + axes_.description(); }
  const ElasticModuli &elastic() const override { return law_.elastic(); }
  double bound_stiffness(const SymmetricTensor<2, 3> &tau) const override {
    return law_.bound_stiffness(tau);
  }
  double bound_stiffness_at(const double *state, const SymmetricTensor<2, 3> &tau) const override {
    return law_.bound_stiffness_at(state, tau);
  }
  bool has_bound_of_stiffness() const override { return law_.has_bound_of_stiffness(); }
  std::shared_ptr<const FlowStress> shared_flow_stress() const override { return law_.shared_flow_stress(); }
  bool depends_on_temperature() const override { return law_.depends_on_temperature(); }
  bool has_symmetric_moduli() const override { return law_.has_symmetric_moduli(); }
  bool is_rate_form() const override { return false; }
  bool has_exact_dissipation() const override { return law_.has_exact_dissipation(); }

  std::vector<StateField> fields() const override {
    std::vector<StateField> fields = law_.fields();
    fields.push_back({"material axes", n_axes, {"1x", "1y", "1z", "2x", "2y", "2z", "3x", "3y", "3z"}});
    return fields;
  }
  std::size_t n_state() const override { return n_inner_ + n_axes; }
  void initialize(double *state) const override { initialize_at({}, state); }
  void initialize_at(const Tensor<1, 3> &position, double *state) const override {
    law_.initialize_at(position, state);
    const auto axes = axes_.at(position);
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        state[n_inner_ + std::size_t{3} * a + i] = axes[a][i];
  }

  bool update(const Tensor<2, 3> &F, const double J, const PointStep &step, const double *state_n,
              double *state, SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const override {
    std::copy_n(state_n + n_inner_, n_axes, state + n_inner_);
    return law_.update(turn(F, state_n), J, step, state_n, state, tau, moduli);
  }
  double stored_energy(const Tensor<2, 3> &F, const double J, const double *state) const override {
    return law_.stored_energy(turn(F, state), J, state);
  }
  double dissipated_energy(const double *state) const override { return law_.dissipated_energy(state); }
  double equivalent_plastic_strain(const double *state) const override {
    return law_.equivalent_plastic_strain(state);
  }

  /// The axes of the state remain.
  void set_stress(const Tensor<2, 3> &F, const SymmetricTensor<2, 3> &deviator,
                  const double equivalent_plastic_strain, double *state) const override {
    law_.set_stress(turn(F, state), deviator, equivalent_plastic_strain, state);
  }
  std::vector<double> memory(const Tensor<2, 3> &F, const double *state) const override {
    return law_.memory(turn(F, state), state);
  }
  void remember(const Tensor<2, 3> &F, const std::vector<double> &memory, double *state) const override {
    law_.remember(turn(F, state), memory, state);
  }

  std::optional<double> min_wave_stiffness(const std::array<double, 3> &stretches) const override {
    return law_.min_wave_stiffness(stretches);
  }
  std::optional<double> flow_slope(const double *state, const double temperature) const override {
    return law_.flow_slope(state, temperature);
  }

private:
  /// Returns F Q.
  Tensor<2, 3> turn(const Tensor<2, 3> &F, const double *state) const {
    const double *const axes = state + n_inner_;
    Tensor<2, 3> turned;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int j = 0; j < 3; ++j)
          turned[i][a] += F[i][j] * axes[3 * a + j];
    return turned;
  }

  SharedLaw shared_law_;
  const SpatialLaw &law_;
  Axes axes_;
  std::size_t n_inner_;
};

} // namespace

SharedLaw orient(const SharedLaw &law, const Axes &axes) {
  if (law->is_rate_form())
    throw std::invalid_argument("material axes that differ from point to point need a law that is not in "
                                "rate form");
  return std::make_shared<const OrientedLaw>(law, axes);
}

} // namespace billet
