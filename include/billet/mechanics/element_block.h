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

/// Element formulation of a body.
struct ElementFormulation {
  using Element = BrickElement;

  Element element = Element::assumed_strain;
  unsigned int points_through = 2; ///< for assumed strains: one of all_points_through
  /// Whether an unsymmetric tangent is replaced by its symmetric part.
  bool is_symmetrised = false;
  std::vector<double> constants; ///< ElementChoice::constants
};

/// Averages and integrals over one element, for output.
struct ElementSummary {
  dealii::SymmetricTensor<2, 3> cauchy_stress; ///< average over the current volume [stress]
  double equivalent_plastic_strain = 0.;       ///< average over the reference volume
  double elastic_energy = 0.;                  ///< integral [energy]
  double plastic_work = 0.;                    ///< integral [energy]
  double hourglass_energy = 0.;                ///< energy stored in the stabilisation [energy]
  double stiffness_bound = 0.; ///< maximum over the points of PointLaw::bound_stiffness() [stress]
};

/// Place of the states of the law in the numbers of an element: `n_points` states, one after the
/// other.
struct PointStates {
  std::size_t first = 0, n_points = 0;
};

/// Averages of the numbers of PointLaw::fields(): of an element and, if it has layers, of
/// `layer_names`.
using StateAverages = std::vector<std::vector<double>>;

/// Returns the mean of the corners [length].
dealii::Tensor<1, 3> find_centre(const ElementVectors &positions);

/// Selects a history: that at the start of the step, or that of the last evaluate().
enum class Beat { committed, evaluated };

/// All elements of one body on one rank, with the same law and with history in one array. The law
/// is fixed at construction; there is no dispatch per element. History advances in two stages. The
/// first, evaluate(), computes the end of the step from the history at its start, and may be called
/// repeatedly. The second, commit(), makes the last evaluation the new start.
class ElementBlock {
public:
  virtual ~ElementBlock() = default;

  /// Sets the nodal positions of the undeformed elements [length] and their thickness axes, which
  /// are used if there are more than two points along them. Returns false, with the index of the
  /// first such element, if one is degenerate or inverted.
  virtual bool initialize(const std::vector<ElementVectors> &positions,
                          const std::vector<ThicknessAxis> &axes, std::size_t &offender) = 0;
  bool initialize(const std::vector<ElementVectors> &positions, std::size_t &offender) {
    return initialize(positions, std::vector<ThicknessAxis>(positions.size()), offender);
  }

  /// Returns the axes through the thickness; empty with two points.
  virtual std::vector<ThicknessAxis> thickness_axes() const = 0;

  virtual std::size_t size() const = 0;

  /// Sets PointStep::temperature, for evaluations of steps and of known states.
  virtual void set_temperature(double temperature) = 0;

  /// Overwrites `force` [force] and, if given, `matrix` [force/length]. Returns false if the state
  /// is inadmissible (det F ≤ 0, not finite): the step must be cut.
  virtual bool evaluate(std::size_t element, const ElementVectors &displacements, ElementVectors &force,
                        ElementMatrix *matrix, const PointStep &step = {}) = 0;

  virtual void commit() = 0;

  /// Returns averages and integrals at a history and the displacements that belong to it.
  virtual ElementSummary summarize(std::size_t element, const ElementVectors &displacements,
                                   Beat beat = Beat::committed) const = 0;

  /// Returns averages of the layers at the start of the step, given the displacements that belong
  /// to its history. Returns none with two points through the thickness.
  virtual std::optional<LayerSummaries> summarize_layers(std::size_t element,
                                                         const ElementVectors &displacements) const = 0;

  /// Returns the number of doubles of history per element, for both stages.
  virtual std::size_t history_size() const = 0;

  // For checkpoints: the history at the start of the step, as numbers.
  virtual std::size_t state_size() const = 0; ///< per element; 0 without history
  virtual void get_state(std::size_t element, double *state) const = 0;
  virtual void set_state(std::size_t element, const double *state) = 0;

  // To continue from the results of another formulation:
  /// Returns the stress at the start of the step, given the displacements that belong to its
  /// history.
  virtual ElementStress compute_stress(std::size_t element, const ElementVectors &displacements) const = 0;
  /// Sets the history for which these displacements have this stress; without history the stress
  /// follows from the displacements alone.
  virtual void set_stress(std::size_t element, const ElementVectors &displacements,
                          const ElementStress &stress) = 0;

  // To find the law's state by the names of its fields:
  virtual PointStates point_states() const = 0; ///< in the numbers of get_state()
  /// Returns averages over the reference volume at the start of the step.
  virtual StateAverages average_states(std::size_t element) const = 0;

  // To continue on a finer mesh:
  /// Sets the history of one of the eight elements into which an element with this state was
  /// divided, (R4) and (R5) of doc/theory. `child`: its number, in deal.II's order. For two points
  /// through the thickness.
  virtual void set_parent_state(std::size_t element, const double *state, unsigned int child) = 0;
};

/// Makes the block; every element supports every law.
std::unique_ptr<ElementBlock> make_element_block(const std::shared_ptr<const PointLaw> &law,
                                                 const ElementFormulation &formulation = {});

} // namespace billet

#endif
