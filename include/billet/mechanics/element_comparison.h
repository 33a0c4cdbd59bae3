// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_ELEMENT_COMPARISON_H
#define BILLET_MECHANICS_ELEMENT_COMPARISON_H

#include "billet/mechanics/element_block.h"

#include <memory>

namespace billet {

/// Energies of the same nodal displacements under different elements [energy].
struct ElementEnergies {
  double used = 0.;           ///< the element of the body
  double one_point = 0.;      ///< the one-point element
  double accurate = 0.;       ///< AssumedStrainElement
  double tapered = 0.;        ///< extra energy under the same forces if the bricks were not tapered, (L4)
  double hourglass = 0.;      ///< part of `used`: stabilisation energy of a one-point element
  double plastic = 0.;        ///< part of `used`: dissipated energy (one-point elements, assumed strains)
  double plastic_within = 0.; ///< same from strains between the points, (L3) (assumed strains)

  /// Returns the factor by which the element is too stiff, (L1): a lower bound; an approximation for tapered
  /// bricks.
  double factor() const { return accurate > 0. ? (used + tapered) / accurate : 1.; }
  ElementEnergies &operator+=(const ElementEnergies &other) {
    used += other.used;
    one_point += other.one_point;
    accurate += other.accurate;
    tapered += other.tapered;
    hourglass += other.hourglass;
    plastic += other.plastic;
    plastic_within += other.plastic_within;
    return *this;
  }
};

/// Compares the element of a body with one that bends accurately, by the energy of given displacements; no
/// equations are solved. The energy follows from total strains, (L2) of doc/theory.md: Hencky's
/// hyperelasticity and, where the body yields, the deformation theory of plasticity. It does not depend on
/// history.
class ElementComparison {
public:
  /// Only the element of `formulation` is used.
  ElementComparison(std::shared_ptr<const PointLaw> law, const ElementFormulation &formulation);

  /// Adds the energies of an element. Returns false, without changing `energies`, if the element is inverted.
  bool compare(const ElementVectors &positions, const ElementVectors &displacements,
               ElementEnergies &energies) const;

  /// Returns the energy per reference volume of a volumetric logarithmic strain and of the deviatoric energy
  /// that an elastic body would store [stress].
  double energy(double volumetric_strain, double elastic_deviatoric_energy) const;

private:
  /// Measures of logarithmic strains, the arguments of energy().
  struct Strains {
    double volumetric, deviatoric_energy;
  };
  Strains measure(const dealii::Tensor<2, 3> &F) const;
  double energy(const Strains &strains) const {
    return energy(strains.volumetric, strains.deviatoric_energy);
  }
  /// Returns (L4) with (L5), for elastic bricks.
  double energy_of_taper(const ElementVectors &positions, const ElementVectors &displacements) const;
  /// Returns α of (L2).
  double equivalent_plastic_strain(double elastic_deviatoric_energy) const;
  /// Returns w_p of (L3), the dissipation per volume [stress].
  double dissipation(const Strains &strains) const;
  /// Returns the mean dissipation over a brick, with F given at 2³ points and trilinear between them.
  double dissipation_between(const std::array<dealii::Tensor<2, 3>, n_element_points> &F) const;
  /// Adds to `used`, `hourglass` and `plastic`. Returns false if the element is inverted.
  bool add_one_point(const ElementVectors &positions, const ElementVectors &displacements,
                     ElementEnergies &energies) const;

  ElasticModuli elastic_;
  ElementFormulation formulation_;
  std::shared_ptr<const PointLaw> law_;
  const FlowStress *flow_; ///< null for elastic bodies
};

} // namespace billet

#endif
