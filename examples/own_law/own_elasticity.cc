// SPDX-License-Identifier: LGPL-2.1-or-later
// A compressible solid: ψ = ½ κ (J − 1)² + ½ G (tr b̄ − 3), with b̄ = J^(−2/3) F Fᵀ.

#include <billet/material/elasticity.h>
#include <billet/material/law_adapter.h>
#include <billet/material/neo_hookean.h>

using namespace billet;

namespace {

class QuadraticVolume {
public:
  struct History {}; // an elastic law has no state
  using Moduli = SpatialModuli;
  static constexpr bool has_plasticity = false, is_rate_form = false, has_symmetric_moduli = true,
                        has_exact_dissipation = true;

  explicit QuadraticVolume(const ElasticModuli &elastic) : elastic_(elastic) {}

  /// Kirchhoff stress τ = κ J (J − 1) 1 + G dev b̄ at the deformation gradient F, and its moduli if they are
  /// asked for. Returns false where the law has no answer: the step is then cut.
  bool update(const dealii::Tensor<2, 3> &F, const History &, History &, dealii::SymmetricTensor<2, 3> &tau,
              SpatialModuli *moduli, const PointStep & = {}) const {
    IsochoricState state;
    if (!compute_isochoric_state(F, dealii::unit_symmetric_tensor<3>(), state))
      return false;
    const double J = state.J, pressure = elastic_.bulk * J * (J - 1.);
    tau = elastic_.shear * state.deviator + pressure * dealii::unit_symmetric_tensor<3>();
    if (moduli == nullptr)
      return true;
    compute_neo_hookean_moduli({0., elastic_.shear}, state, 1., {}, *moduli); // of the second part of ψ
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 6; ++j)
        (*moduli)[i][j] += (i < 3 && j < 3 ? elastic_.bulk * J * (2. * J - 1.) : 0.) -
                           (i == j ? (i < 3 ? 2. : 1.) * pressure : 0.);
    return true;
  }
  double elastic_energy(const dealii::Tensor<2, 3> &F, const History &) const {
    IsochoricState state;
    if (!compute_isochoric_state(F, dealii::unit_symmetric_tensor<3>(), state))
      return 0.;
    return compute_elastic_energy({0., elastic_.shear}, state) +
           0.5 * elastic_.bulk * (state.J - 1.) * (state.J - 1.);
  }
  static double plastic_work(const History &) { return 0.; }
  static double equivalent_plastic_strain(const History &) { return 0.; }
  const ElasticModuli &elastic() const { return elastic_; }
  double min_wave_stiffness(const Stretches &stretches) const {
    return billet::min_wave_stiffness(*this, elastic_.shear, stretches);
  }

private:
  ElasticModuli elastic_;
};

SharedLaw make(const ElasticModuli &elastic, SharedFlow flow) {
  return flow ? nullptr // no plasticity with this elasticity
              : std::make_shared<const LawAdapter<QuadraticVolume>>("quadratic volume",
                                                                    QuadraticVolume(elastic));
}

} // namespace

ElasticityType quadratic_volume_type() {
  return isotropic_elasticity_type("quadratic volume", "energy (J - 1)^2 of the volume", &make);
}
