// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_HYPERELASTIC_H
#define BILLET_MATERIAL_HYPERELASTIC_H

#include "billet/material/drucker.h"
#include "billet/material/hencky.h"
#include "billet/material/volumetric_law.h"

#include <string>
#include <utility>

namespace billet {

/// Response of an isotropic hyperelastic law in the principal frame of b = F Fᵀ, (V1) and (V2) of
/// doc/theory/rubber.md.
struct HyperelasticState {
  PrincipalElasticState principal;
  double J, mean_stress;      ///< det F, and p = J U'(J) [stress]
  double volumetric_slope;    ///< dp/d ln J [stress]
  IsochoricResponse response; ///< with the deviator of t_A for t_A
};

/// Hyperelastic law W(λ̄) + U(J) with a symmetric tangent and no history. Prony's series stands on
/// it.
class HyperelasticLaw : public SpatialLaw {
public:
  HyperelasticLaw(std::string name, SharedEnergy isochoric, const VolumetricEnergy &volumetric)
      : name_(std::move(name)), isochoric_(std::move(isochoric)),
        volumetric_(volumetric), moduli_{volumetric.bulk_modulus(), isochoric_->shear_modulus()} {}

  std::string name() const override { return name_; }
  /// With the stretches at which it is stable.
  std::string summary() const override;
  const ElasticModuli &elastic() const override { return moduli_; }
  double bound_stiffness(const dealii::SymmetricTensor<2, 3> &tau) const override;
  std::shared_ptr<const FlowStress> shared_flow_stress() const override { return nullptr; }
  bool has_symmetric_moduli() const override { return true; }
  bool is_rate_form() const override { return false; }
  bool has_exact_dissipation() const override { return true; }

  std::vector<StateField> fields() const override { return {}; }
  std::size_t n_state() const override { return 0; }
  void initialize(double *) const override {}

  bool update(const dealii::Tensor<2, 3> &F, double J, const PointStep &step, const double *state_n,
              double *state, dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const override;
  double stored_energy(const dealii::Tensor<2, 3> &F, double J, const double *state) const override;
  double dissipated_energy(const double *) const override { return 0.; }
  double equivalent_plastic_strain(const double *) const override { return 0.; }
  void set_stress(const dealii::Tensor<2, 3> &, const dealii::SymmetricTensor<2, 3> &, double,
                  double *) const override {}
  std::optional<double> min_wave_stiffness(const std::array<double, 3> &stretches) const override;

  const IsochoricEnergy &isochoric_energy() const { return *isochoric_; }
  const VolumetricEnergy &volumetric_energy() const { return volumetric_; }

  /// Computes the state at F. Returns false if F is inadmissible.
  bool respond(const dealii::Tensor<2, 3> &F, HyperelasticState &state) const;

private:
  std::string name_;
  SharedEnergy isochoric_;
  VolumetricEnergy volumetric_;
  ElasticModuli moduli_;
};

/// Returns Σ_A (p + share t_A) n_A ⊗ n_A [stress].
dealii::SymmetricTensor<2, 3> compute_hyperelastic_stress(const HyperelasticState &state, double share = 1.);

/// Overwrites `moduli` with those of the stress above, (V2):
///   c = Σ_AB (dp/d ln J + share ∂dev t_A/∂ε_B − 2 τ_A δ_AB) m_A ⊗ m_B + Σ_{A<B} 4 g_AB s_AB ⊗ s_AB
/// with g_AB = share (t_A − t_B)/(b_A/b_B − 1) − τ_B.
void compute_hyperelastic_moduli(const HyperelasticState &state, double share, SpatialModuli &moduli);

/// Returns an elasticity that is this law, without plasticity, and Young's modulus of it [stress].
std::shared_ptr<const Elasticity> make_elasticity(SharedLaw law, double young);

} // namespace billet

#endif
