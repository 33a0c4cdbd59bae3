// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_ELEMENT_BLOCK_H
#define BILLET_MECHANICS_ELEMENT_BLOCK_H

#include "billet/mechanics/element_type.h"
#include "billet/mechanics/mean_dilatation.h"
#include "billet/mechanics/thickness.h"

#include <memory>
#include <string>
#include <vector>

namespace billet {

/// How the elements of a body are computed.
struct ElementFormulation {
  using Element = BrickElement;

  Element element = Element::assumed_strain;
  unsigned int points_through = 2; ///< of assumed strains, through the thickness: one of all_points_through
  bool is_symmetrised = false;     ///< whether an unsymmetric tangent is replaced by its symmetric part
};

/// What a history means: element, points through the thickness unless two, and elasticity in words.
std::string describe(const ElementFormulation &formulation, const PointLaw &law);

/// Averages and integrals over one element, for output.
struct ElementSummary {
  dealii::SymmetricTensor<2, 3> cauchy_stress; ///< average over the current volume [stress]
  double equivalent_plastic_strain = 0.;       ///< average over the reference volume
  double elastic_energy = 0.;                  ///< integral [energy]
  double plastic_work = 0.;                    ///< integral [energy]
  double hourglass_energy = 0.;                ///< stored in the stabilisation [energy]
  double stiffness_bound = 0.; ///< maximum over the points of PointLaw::bound_stiffness() [stress]
};

/// Whose history: that at the start of the step, or that of the last evaluate().
enum class Beat { committed, evaluated };

/// All elements of one body on one rank: the same law, history in one array. The law is fixed when the block
/// is made; nothing is decided per element. History advances in two beats: evaluate() computes the end of the
/// step from the history at its start, as often as it is called; commit() makes the last evaluation the new
/// start.
class ElementBlock {
public:
  virtual ~ElementBlock() = default;

  /// Nodal positions of the undeformed elements [length]; their axes through the thickness, read where there
  /// are more than two points along them. False, with the index of the first offender, if one is degenerate
  /// or inverted.
  virtual bool initialize(const std::vector<ElementVectors> &positions,
                          const std::vector<ThicknessAxis> &axes, std::size_t &offender) = 0;
  bool initialize(const std::vector<ElementVectors> &positions, std::size_t &offender) {
    return initialize(positions, std::vector<ThicknessAxis>(positions.size()), offender);
  }

  /// Axes through the thickness; empty with two points.
  virtual std::vector<ThicknessAxis> thickness_axes() const = 0;

  virtual std::size_t size() const = 0;

  /// Overwrites `force` [force] and, if given, `matrix` [force/length]. False if the state is not admissible
  /// (det F ≤ 0, not finite): the step has to be cut.
  virtual bool evaluate(std::size_t element, const ElementVectors &displacements, ElementVectors &force,
                        ElementMatrix *matrix, const PointStep &step = {}) = 0;

  virtual void commit() = 0;

  /// At a history and the displacements that belong to it.
  virtual ElementSummary summarize(std::size_t element, const ElementVectors &displacements,
                                   Beat beat = Beat::committed) const = 0;

  /// Returns averages of the layers at the history at the start of the step and the displacements that belong
  /// to it; none with two points through the thickness.
  virtual std::optional<LayerSummaries> summarize_layers(std::size_t element,
                                                         const ElementVectors &displacements) const = 0;

  /// Doubles of history kept per element, both beats counted.
  virtual std::size_t history_size() const = 0;

  // For checkpoints: the history at the start of the step, as numbers.
  virtual std::size_t state_size() const = 0; ///< of an element; 0 without history
  virtual void get_state(std::size_t element, double *state) const = 0;
  virtual void set_state(std::size_t element, const double *state) = 0;

  // To go on with what another formulation has computed:
  /// At the history at the start of the step and the displacements that belong to it.
  virtual ElementStress compute_stress(std::size_t element, const ElementVectors &displacements) const = 0;
  /// Makes the history the one which, at these displacements, has this stress; without history it follows
  /// from the displacements alone.
  virtual void set_stress(std::size_t element, const ElementVectors &displacements,
                          const ElementStress &stress) = 0;
};

/// Every element goes with every law.
std::unique_ptr<ElementBlock> make_element_block(const std::shared_ptr<const PointLaw> &law,
                                                 const ElementFormulation &formulation = {});

} // namespace billet

#endif
