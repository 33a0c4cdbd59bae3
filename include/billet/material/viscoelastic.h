// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_VISCOELASTIC_H
#define BILLET_MATERIAL_VISCOELASTIC_H

#include "billet/material/hyperelastic.h"

#include <memory>
#include <string>
#include <vector>

namespace billet {

/// Prony's series of the isochoric stress, (V7) of doc/theory/rubber.md: the share g of the
/// instantaneous stress that a term relaxes, and its relaxation time.
struct PronySeries {
  std::vector<double> moduli; ///< g_i > 0, whose sum is below 1
  std::vector<double> times;  ///< τ_i > 0 [time]

  /// Returns the share of the stress that does not relax.
  double lasting_share() const;
};

std::vector<TypeParameter> prony_parameters();
/// Reads the series; empty if the user gives none. Refuses others than those above.
PronySeries read_prony_series(const TypeInput &input);

/// Finite linear viscoelasticity of the isochoric part of a hyperelastic law, (V7) to (V10) of
/// doc/theory/rubber.md. The stress T that is conjugate to the logarithmic strain ½ ln C relaxes;
/// the pressure does not. The recurrence is exact for a T that is linear in time, at any length of
/// the step (Taylor, Pister & Goudreau 1970). Dissipation is never negative where Drucker's
/// condition holds.
class ViscoelasticLaw final : public SpatialLaw {
public:
  ViscoelasticLaw(HyperelasticLaw elastic, PronySeries series)
      : elastic_(std::move(elastic)), series_(std::move(series)) {}

  std::string name() const override { return elastic_.name(); }
  std::string summary() const override;
  /// Returns those of a fast deformation.
  const ElasticModuli &elastic() const override { return elastic_.elastic(); }
  double bound_stiffness(const dealii::SymmetricTensor<2, 3> &tau) const override;
  std::shared_ptr<const FlowStress> shared_flow_stress() const override { return nullptr; }
  bool has_symmetric_moduli() const override { return true; }
  bool is_rate_form() const override { return false; }
  bool has_exact_dissipation() const override { return true; }

  std::vector<StateField> fields() const override;
  std::size_t n_state() const override { return n_common + n_term * series_.times.size(); }
  void initialize(double *state) const override;

  bool update(const dealii::Tensor<2, 3> &F, double J, const PointStep &step, const double *state_n,
              double *state, dealii::SymmetricTensor<2, 3> &tau, SpatialModuli *moduli) const override;
  double stored_energy(const dealii::Tensor<2, 3> &F, double J, const double *state) const override;
  double dissipated_energy(const double *state) const override { return state[6]; }
  double equivalent_plastic_strain(const double *) const override { return 0.; }
  void set_stress(const dealii::Tensor<2, 3> &F, const dealii::SymmetricTensor<2, 3> &deviator,
                  double equivalent_plastic_strain, double *state) const override;
  std::vector<double> memory(const dealii::Tensor<2, 3> &F, const double *state) const override;
  /// Keeps the stress: the terms share what is missing by their moduli.
  void remember(const dealii::Tensor<2, 3> &F, const std::vector<double> &memory,
                double *state) const override;
  /// Returns that of a fast deformation from rest.
  std::optional<double> min_wave_stiffness(const std::array<double, 3> &stretches) const override {
    return elastic_.min_wave_stiffness(stretches);
  }

private:
  // The state: T of the elastic law and the dissipated energy, then of each term its stress and
  // compliance.
  static constexpr std::size_t n_common = 7, n_term = 7;

  HyperelasticLaw elastic_;
  PronySeries series_;
};

/// Returns the law with this series; without one, the elastic law.
SharedLaw make_hyperelastic_law(HyperelasticLaw elastic, PronySeries series);

/// Adds Prony's series to a type of two moduli whose elastic law is the hyperelastic one of `make`
/// and of a logarithmic volumetric energy. Without a series the type stays as it is.
ElasticityType with_prony_series(ElasticityType type, SharedEnergy (*make)(double shear));

} // namespace billet

#endif
