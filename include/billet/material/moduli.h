// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_MODULI_H
#define BILLET_MATERIAL_MODULI_H

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <array>

namespace billet {

/// Bulk and shear modulus of an isotropic solid [stress].
struct ElasticModuli {
  double bulk;
  double shear;

  static ElasticModuli from_young_poisson(const double young, const double poisson) {
    return {young / (3. * (1. - 2. * poisson)), young / (2. * (1. + poisson))};
  }
  double poisson_ratio() const { return (3. * bulk - 2. * shear) / (6. * bulk + 2. * shear); }
};

/// Tangent moduli c of the Lie derivative of the Kirchhoff stress, L_v τ = c : d [stress]. The
/// 6 × 6 matrix maps (d11, d22, d33, 2 d12, 2 d13, 2 d23) onto (τ11, τ22, τ33, τ12, τ13, τ23).
using SpatialModuli = std::array<std::array<double, 6>, 6>;

/// Derivative of a stress with respect to the velocity gradient, δτ = A : L with L = δF F⁻¹, for
/// laws without moduli in the sense of SpatialModuli. Rows are τ11, τ22, τ33, τ12, τ13, τ23;
/// columns are L11, L12, L13, L21, ... L33 [stress].
struct GradientModuli : std::array<std::array<double, 9>, 6> {
  double volumetric =
      0.; ///< derivative of the pressure tr τ/3 by ln J, which the rows do not contain [stress]
};

/// Returns an upper bound of the stiffness of waves per squared velocity gradient, (X9) of
/// doc/theory with 2G [stress]. The law does not stiffen but by the rotation and stretch of its
/// Kirchhoff stress.
double bound_elastic_stiffness(const ElasticModuli &moduli, const dealii::SymmetricTensor<2, 3> &tau);

/// Return an upper bound of the stiffness of waves per squared velocity gradient, as
/// PointLaw::bound_stiffness() does [stress]. It follows from the moduli and the Kirchhoff stress
/// at a point, (X17) of doc/theory.
double bound_by_moduli(const SpatialModuli &moduli, const dealii::SymmetricTensor<2, 3> &tau);
double bound_by_moduli(const GradientModuli &moduli, const dealii::SymmetricTensor<2, 3> &tau);

} // namespace billet

#endif
