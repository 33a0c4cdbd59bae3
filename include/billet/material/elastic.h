// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_ELASTIC_H
#define BILLET_MATERIAL_ELASTIC_H

#include "billet/material/hencky.h"
#include "billet/material/point_law.h"
#include "billet/material/stability.h"

namespace billet {

/// Returns the stored energy per reference volume, ½ κ (tr ε)² + G dev ε : dev ε [stress].
inline double compute_elastic_energy(const ElasticModuli &elastic, const PrincipalElasticState &state) {
  double dev_squared = 0.;
  for (const double e : state.deviatoric_log_strains)
    dev_squared += e * e;
  return 0.5 * elastic.bulk * state.volumetric_log_strain * state.volumetric_log_strain +
         elastic.shear * dev_squared;
}

/// Hencky's hyperelasticity: Kirchhoff stress linear in the logarithmic strain. No history.
class HenckyElasticity {
public:
  struct History {};
  using Moduli = SpatialModuli;
  static constexpr bool has_plasticity = false, is_rate_form = false, has_symmetric_moduli = true,
                        has_exact_dissipation = true;
  static constexpr LaneLaw lane_law = LaneLaw::hencky;

  explicit HenckyElasticity(const ElasticModuli &elastic) : elastic_(elastic) {}

  /// Computes the stress (and, if `moduli` is given, the tangent) at deformation gradient F; see
  /// HenckyPlasticity::update().
  bool update(const dealii::Tensor<2, 3> &F, const History &, History &, dealii::SymmetricTensor<2, 3> &tau,
              SpatialModuli *moduli, const PointStep & = {}) const {
    PrincipalElasticState state;
    PrincipalResponse response;
    if (!respond(F, state, response))
      return false;
    tau = compute_kirchhoff_stress(state, response);
    if (moduli != nullptr)
      compute_spatial_moduli(state, response, elastic_, *moduli);
    return true;
  }

  double elastic_energy(const dealii::Tensor<2, 3> &F, const History &) const {
    PrincipalElasticState state;
    PrincipalResponse response;
    return respond(F, state, response) ? compute_elastic_energy(elastic_, state) : 0.;
  }

  static double plastic_work(const History &) { return 0.; }
  static double equivalent_plastic_strain(const History &) { return 0.; }
  const ElasticModuli &elastic() const { return elastic_; }
  double bound_stiffness(const dealii::SymmetricTensor<2, 3> &tau) const {
    return bound_elastic_stiffness(elastic_, tau);
  }
  double min_wave_stiffness(const Stretches &stretches) const {
    return billet::min_wave_stiffness(*this, elastic_.shear, stretches);
  }

private:
  bool respond(const dealii::Tensor<2, 3> &F, PrincipalElasticState &state,
               PrincipalResponse &response) const {
    if (!compute_principal_state(dealii::symmetrize(F * dealii::transpose(F)), state))
      return false;
    for (unsigned int a = 0; a < 3; ++a)
      response.stress[a] =
          elastic_.bulk * state.volumetric_log_strain + 2. * elastic_.shear * state.deviatoric_log_strains[a];
    return true;
  }

  ElasticModuli elastic_;
};

} // namespace billet

#endif
