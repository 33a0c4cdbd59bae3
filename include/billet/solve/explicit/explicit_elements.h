// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_EXPLICIT_ELEMENTS_H
#define BILLET_SOLVE_EXPLICIT_EXPLICIT_ELEMENTS_H

#include "billet/discretization/local_nodes.h"
#include "billet/mechanics/explicit_block.h"
#include "billet/scene/scene.h"
#include "billet/solve/element_points.h"
#include "billet/solve/explicit/explicit_clock.h"
#include "billet/solve/restart.h"
#include "billet/usage.h"

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace billet {

/// Works since time 0 on one rank [energy].
struct ExplicitWorks {
  double external = 0., plastic = 0., friction = 0., viscous = 0.;
};

/// Element of a rank with its stable step, undeformed and at rest.
struct LimitingElement {
  /// Index of Discretization::elements(body).
  std::size_t body = 0, element = 0;
  /// Infinite if the rank has no elements [time].
  double step = std::numeric_limits<double>::infinity();
};

/// Elements of all bodies on a rank, for central differences.
class ExplicitElements {
public:
  /// Throws InputError, on all ranks, for a formulation or an element that is not admissible.
  /// Collective.
  ExplicitElements(const Scene &scene, const LocalNodes &nodes);

  /// Returns this rank's share of the lumped mass of each of its nodes [mass].
  std::vector<double> lumped_masses() const;
  /// Multiplies densities so that no element has a shorter stable step than `min_step` [time].
  /// Returns the mass that this adds on this rank.
  double scale_mass(double min_step);

  /// Returns this rank's element that has the shortest stable step, undeformed and at rest, with
  /// the masses that scale_mass(`min_step`) adds if `min_step` > 0. It leaves the elements as they
  /// are, and costs three evaluations of them.
  LimitingElement find_limiting_element(double min_step) const;

  /// Subtracts internal and viscous forces from those of `nodes`, advances histories by the time
  /// since the last forces, and adds to `works`. Returns the stable step of this rank's elements
  /// [time]. Throws SolutionFailure, on this rank alone, if an element is inverted.
  double add_forces(const ExplicitBlock::Nodes &nodes, const ExplicitClock &clock, ExplicitWorks &works);
  /// Return energies of this rank at the last forces [energy].
  double elastic_energy() const { return elastic_energy_; }
  double hourglass_energy() const { return hourglass_energy_; }
  /// Sets them until the next forces, for this rank's share of a state that is loaded [energy].
  void set_energies(const double elastic, const double hourglass) {
    elastic_energy_ = elastic;
    hourglass_energy_ = hourglass;
  }

  std::vector<ElementSummary> summarize(std::size_t body, const NodalVectors &displacements) const;
  std::vector<StateAverages> average_states(std::size_t body, const NodalVectors &displacements) const;
  std::vector<ElementPoints> element_points(std::size_t body, const NodalVectors &displacements) const;
  /// Returns the number of doubles of history on this rank.
  std::size_t history_size() const;

  // For checkpoints, in the groups of bodies.
  void save(StateWriter &writer) const;
  /// Whether the checkpoint's histories belong to the same formulations.
  bool has_same_formulations(StateReader &reader) const;
  /// `displacements`: those of the last forces.
  void load(StateReader &reader, double t, const NodalVectors &displacements);
  /// Sets histories that give the stresses of another formulation at these displacements, in both
  /// forms (`ghosted`: with ghosts).
  void load_stresses(StateReader &reader, const NodalVectors &displacements, const Vector &ghosted, double t);

private:
  void make_blocks();
  void set_temperatures(double t);
  /// Loads a refined body from the histories of the elements before, one row for each of their
  /// parts.
  void load_parents(std::size_t body, const std::vector<double> &rows, const NodalVectors &displacements);
  double stable_step_of(std::size_t body, std::size_t begin, std::size_t end, double min_step) const;
  void count_memory();
  HistoryFormat history_format(std::size_t body) const;
  SolutionFailure describe_inverted(std::size_t body, std::size_t element, const double *displacements,
                                    const ExplicitClock &clock) const;

  const Scene &scene_;
  const LocalNodes &nodes_;
  std::vector<std::unique_ptr<ExplicitBlock>> blocks_; ///< by body
  HeldMemory plastic_memory_{Capability::plasticity}, stabilised_memory_{Capability::stabilisation};
  double elastic_energy_ = 0., hourglass_energy_ = 0.;
};

} // namespace billet

#endif
