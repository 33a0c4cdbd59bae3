// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_ELEMENT_COMPARISON_H
#define BILLET_MECHANICS_ELEMENT_COMPARISON_H

#include "billet/mechanics/element_block.h"

#include <algorithm>
#include <array>
#include <memory>

namespace billet {

/// Measures of logarithmic strains, which determine the energy.
struct LogarithmicStrains {
  double volumetric, deviatoric_energy;
};

/// Energies of the same nodal displacements under different elements [energy].
struct ElementEnergies {
  double used = 0.;      ///< the element of the body
  double one_point = 0.; ///< the one-point element
  double accurate = 0.;  ///< AssumedStrainElement
  /// Extra energy under the same forces if the bricks were not tapered, (L4).
  double tapered = 0.;
  double hourglass = 0.; ///< part of `used`: stabilisation energy of a one-point element
  /// Part of `used`: dissipated energy (one-point elements, assumed strains).
  double plastic = 0.;
  double plastic_within = 0.; ///< same from strains between the points, (L3) (assumed strains)
  /// Part of `used` in elastic bricks whose faces are beyond yield, (L10).
  double beyond_yield = 0.;
  /// Largest stress at the faces of such bricks, per yield stress, (L10).
  double face_stress = 0.;

  /// Returns the factor by which the element is too stiff, (L1): a lower bound; an approximation
  /// for tapered bricks.
  double factor() const { return accurate > 0. ? (used + tapered) / accurate : 1.; }
  ElementEnergies &operator+=(const ElementEnergies &other) {
    used += other.used;
    one_point += other.one_point;
    accurate += other.accurate;
    tapered += other.tapered;
    hourglass += other.hourglass;
    plastic += other.plastic;
    plastic_within += other.plastic_within;
    beyond_yield += other.beyond_yield;
    face_stress = std::max(face_stress, other.face_stress);
    return *this;
  }
};

/// Strains of a brick at eight points, and the energies there.
struct PointEnergies {
  std::array<dealii::Tensor<2, 3>, n_element_points> F;
  std::array<LogarithmicStrains, n_element_points> strains;
  std::array<double, n_element_points> volumes; ///< undeformed
  double energy = 0., elastic = 0.;             ///< with plastic flow, and without [energy]
};

/// Brick that is compared, with the energies of two elements.
struct ComparedBrick {
  const ElementVectors &positions, &displacements;
  const PointEnergies &accurate;    ///< AssumedStrainElement
  const ElementEnergies &one_point; ///< OnePointElement: used, hourglass, plastic
};

/// Compares the element of a body with one that bends accurately, by the energy of given
/// displacements; no equations are solved. The energy follows from total strains, (L2) of
/// doc/theory.md: Hencky's hyperelasticity and, where the body yields, the deformation theory of
/// plasticity. It does not depend on history.
class ElementComparison {
public:
  /// Only the element of `formulation` is used.
  ElementComparison(std::shared_ptr<const PointLaw> law, const ElementFormulation &formulation);

  /// Adds the energies of an element. Returns false, without changing `energies`, if the element is
  /// inverted.
  bool compare(const ElementVectors &positions, const ElementVectors &displacements,
               ElementEnergies &energies) const;

  /// Returns the energy per reference volume of a volumetric logarithmic strain and of the
  /// deviatoric energy that an elastic body would store [stress].
  double energy(double volumetric_strain, double elastic_deviatoric_energy) const;

  double energy(const LogarithmicStrains &strains) const {
    return energy(strains.volumetric, strains.deviatoric_energy);
  }

  /// Computes the energies at the points of an element. Returns false if it is inverted.
  template <class Element>
  bool compute(const ElementVectors &positions, const ElementVectors &displacements,
               PointEnergies &points) const;
  /// Adds `plastic` and `plastic_within`, if the body yields.
  void add_dissipation(const PointEnergies &points, ElementEnergies &energies) const;
  /// Sets `beyond_yield` and `face_stress` of a brick with two points through each direction.
  void compare_faces(const PointEnergies &points, ElementEnergies &energies) const;
  const ElementFormulation &formulation() const { return formulation_; }

  /// Part of the yield stress by which a face must exceed it to count.
  static constexpr double yield_margin = 0.2;

private:
  using Strains = LogarithmicStrains;
  Strains measure(const dealii::Tensor<2, 3> &F) const;
  /// Returns (L4) with (L5), for elastic bricks.
  double energy_of_taper(const ElementVectors &positions, const ElementVectors &displacements) const;
  /// Returns α of (L2).
  double equivalent_plastic_strain(double elastic_deviatoric_energy) const;
  /// Returns w_p of (L3), the dissipation per volume [stress].
  double dissipation(const Strains &strains) const;
  /// Returns the mean dissipation over a brick, with F given at 2³ points and trilinear between
  /// them.
  double dissipation_between(const std::array<dealii::Tensor<2, 3>, n_element_points> &F) const;
  /// Adds to `used`, `hourglass` and `plastic`. Returns false if the element is inverted.
  bool add_one_point(const ElementVectors &positions, const ElementVectors &displacements,
                     ElementEnergies &energies) const;

  ElasticModuli elastic_;
  ElementFormulation formulation_;
  std::shared_ptr<const PointLaw> law_;
  const FlowStress *flow_; ///< null for elastic bodies
};

template <class Element>
bool ElementComparison::compute(const ElementVectors &positions, const ElementVectors &displacements,
                                PointEnergies &points) const {
  const Element element(elastic_, formulation_);
  typename Element::Reference reference;
  typename Element::Kinematics kinematics;
  if (!element.initialize(positions, reference) || !Element::compute(reference, displacements, kinematics))
    return false;
  points.energy = points.elastic = 0.;
  for (unsigned int q = 0; q < n_element_points; ++q) {
    points.F[q] = Element::template deformation<false>(reference, kinematics, q);
    const Strains strains = points.strains[q] = measure(points.F[q]);
    const double volume = points.volumes[q] = Element::reference_volume(reference, q);
    points.energy += volume * energy(strains);
    points.elastic +=
        volume * (0.5 * elastic_.bulk * strains.volumetric * strains.volumetric + strains.deviatoric_energy);
  }
  return true;
}

/// ElementKind::compare for an element with eight points.
template <class Element>
bool compare_points(const ElementComparison &comparison, const ComparedBrick &brick,
                    ElementEnergies &energies) {
  PointEnergies points;
  if (!comparison.compute<Element>(brick.positions, brick.displacements, points))
    return false;
  energies.used += points.energy;
  return true;
}

} // namespace billet

#endif
