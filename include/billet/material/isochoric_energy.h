// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_ISOCHORIC_ENERGY_H
#define BILLET_MATERIAL_ISOCHORIC_ENERGY_H

#include "billet/material/elasticity.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace billet {

/// Deviatoric principal logarithmic strains e_A = ln λ̄_A, whose sum is 0.
using IsochoricStrains = std::array<double, 3>;

/// Pairs of principal directions, in the order of IsochoricResponse::shear.
inline constexpr std::array<std::array<unsigned int, 2>, 3> principal_pairs = {{{0, 1}, {0, 2}, {1, 2}}};

/// Response of an isochoric stored energy to e, (V2) of doc/theory/rubber.md [stress].
struct IsochoricResponse {
  std::array<double, 3> stress;               ///< t_A = ∂W/∂e_A up to a number that all three share
  std::array<std::array<double, 3>, 3> slope; ///< ∂²W/∂e_A ∂e_B
  /// (t_A − t_B)/(b_A/b_B − 1) of the pairs, b = λ̄². It is exact where stretches coincide.
  std::array<double, 3> shear;
};

/// Isochoric part W of the stored energy of an isotropic elastic solid, as a function of e.
class IsochoricEnergy {
public:
  virtual ~IsochoricEnergy() = default;

  /// Returns G of the undeformed solid [stress].
  virtual double shear_modulus() const = 0;
  /// Returns W per reference volume [stress]; 0 at e = 0.
  virtual double energy(const IsochoricStrains &e) const = 0;
  virtual IsochoricResponse respond(const IsochoricStrains &e) const = 0;
  /// Returns a, for which the largest slope is about 2 G + a (t_max − t_min) at most. It bounds
  /// explicit steps.
  virtual double growth() const = 0;
};
using SharedEnergy = std::shared_ptr<const IsochoricEnergy>;

/// Returns exp(x) − 1 − x without cancellation.
double expm1_minus(double x);

/// Returns W = G Σ e_A², Hencky's.
SharedEnergy make_hencky_energy(double shear);

/// Returns W = Σ_p μ_p/α_p (Σ_A λ̄_A^{α_p} − 3), (V3) (Ogden 1972). With exponents 2 and −2 it is
/// Mooney and Rivlin's. Moduli in stress; both lists have the same size.
SharedEnergy make_ogden_energy(std::vector<double> moduli, std::vector<double> exponents);

/// Returns W = Σ_i c_i (I_1 − 3)^i, i from 1, (V4), with I_1 = Σ λ̄_A² [stress].
SharedEnergy make_invariant_energy(std::vector<double> coefficients);

/// Returns the type of a hyperelastic law with any volumetric law. Bulk modulus and Prony's series
/// are added to the parameters of the isochoric energy. The law is refused if its initial shear
/// modulus is not positive; the message names the parameter `main_key`.
ElasticityType hyperelastic_type(std::string name, std::string meaning, std::vector<TypeParameter> parameters,
                                 std::string main_key, SharedEnergy (*make)(const TypeInput &));

} // namespace billet

#endif
