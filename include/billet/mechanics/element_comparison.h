// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_ELEMENT_COMPARISON_H
#define BILLET_MECHANICS_ELEMENT_COMPARISON_H

#include "billet/mechanics/element_block.h"

#include <memory>

namespace billet {

/// Energies of the same nodal displacements under different elements [energy].
struct ElementEnergies {
  double used = 0.;      ///< the element of the body
  double one_point = 0.; ///< the one-point element
  double accurate = 0.;  ///< AssumedStrainElement
  double tapered = 0.; ///< what bricks would store more under the same forces if they were not tapered, (L4)
  double hourglass = 0.;      ///< of `used`: what a one-point element has by its stabilisation alone
  double plastic = 0.;        ///< of `used`, of one-point elements and assumed strains: what is dissipated
  double plastic_within = 0.; ///< the same by the strains between the points, (L3): of assumed strains

  /// How many times as stiff the element is as it should be, (L1): at least; of tapered bricks about.
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

/// Compares the element of a body with one that bends right, by the energy of given displacements: no
/// equations are solved. The energy is that of total strains, (L2) of doc/theory.md: Hencky's hyperelasticity
/// and, where the body yields, the deformation theory of plasticity. It knows no history.
class ElementComparison {
public:
  /// `formulation`: of its element alone.
  ElementComparison(std::shared_ptr<const PointLaw> law, const ElementFormulation &formulation);

  /// False, and `energies` is left alone, if an element is inside out.
  bool compare(const ElementVectors &positions, const ElementVectors &displacements,
               ElementEnergies &energies) const;

  /// Energy per reference volume of a volumetric logarithmic strain and of what an elastic body would store
  /// by its deviator [stress].
  double energy(double volumetric_strain, double elastic_deviatoric_energy) const;

private:
  /// Of logarithmic strains, as energy() takes them.
  struct Strains {
    double volumetric, deviatoric_energy;
  };
  Strains measure(const dealii::Tensor<2, 3> &F) const;
  double energy(const Strains &strains) const {
    return energy(strains.volumetric, strains.deviatoric_energy);
  }
  /// (L4) with (L5), of elastic bricks.
  double energy_of_taper(const ElementVectors &positions, const ElementVectors &displacements) const;
  /// α of (L2).
  double equivalent_plastic_strain(double elastic_deviatoric_energy) const;
  /// Per volume [stress]; w_p of (L3).
  double dissipation(const Strains &strains) const;
  /// Its mean over a brick whose F is this at 2³ points and trilinear between them.
  double dissipation_between(const std::array<dealii::Tensor<2, 3>, n_element_points> &F) const;
  /// Adds to `used`, `hourglass` and `plastic`; false if the element is inside out.
  bool add_one_point(const ElementVectors &positions, const ElementVectors &displacements,
                     ElementEnergies &energies) const;

  ElasticModuli elastic_;
  ElementFormulation formulation_;
  std::shared_ptr<const PointLaw> law_;
  const FlowStress *flow_; ///< null of elastic bodies
};

} // namespace billet

#endif
