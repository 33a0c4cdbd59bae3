// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FORCES_INTERNAL_FORCES_H
#define BILLET_FORCES_INTERNAL_FORCES_H

#include "billet/discretization/supports.h"
#include "billet/mechanics/element_block.h"
#include "billet/usage.h"

#include <memory>

namespace billet {

/// Nodal forces of the stresses in all bodies, and their tangent.
class InternalForces {
public:
  /// Throws InputError, on all ranks, if an element is inverted in the undeformed mesh.
  InternalForces(const Scene &scene, const Discretization &discretization);

  /// Begins a step of this length that ends at time t [time]; zero evaluates the state at the
  /// start. Throws SolutionFailure, on all ranks, for a temperature that is not finite.
  void start_step(double t, double dt);

  /// Adds the forces [force] to `forces` (additive vector). Returns false if an element on this
  /// rank is not admissible.
  bool assemble_forces(const Vector &displacements, Vector &forces);

  /// Adds the tangent [force/length]. Returns false as assemble_forces() does. For `yield_slack`,
  /// see PointStep.
  bool assemble_tangent(const Vector &displacements, const TangentSystem &system, double yield_slack = 0.);

  /// Makes the state of the last assembly the start of the next step.
  void commit();

  struct Energies {
    double elastic = 0.;
    double plastic = 0.;
    double hourglass = 0.; ///< stored by the stabilisation
    double total() const { return elastic + plastic + hourglass; }
  };
  /// Computes the energies at a history and its displacements; the same on all ranks. Those of an
  /// evaluated state also serve summarize() once the state is committed.
  Energies compute_energies(const Vector &displacements, Beat beat = Beat::committed);

  /// Returns one entry for each owned element of the body, in the order of
  /// Discretization::elements(), at the start of the step and its displacements.
  std::vector<ElementSummary> summarize(std::size_t body, const Vector &displacements) const;

  /// Returns the summaries of the layers; empty if the body has two points through the thickness.
  std::vector<LayerSummaries> summarize_layers(std::size_t body, const Vector &displacements) const;

  /// Returns averages of the law's state for the same elements, at the start of the step.
  std::vector<StateAverages> average_states(std::size_t body) const;

  /// Returns the number of doubles of history on this rank.
  std::size_t history_size() const;

  /// Returns the element block of a body, for checkpoints. Its history may change.
  ElementBlock &block(const std::size_t body) {
    summaries_.clear();
    return *blocks_[body];
  }
  const ElementBlock &block(const std::size_t body) const { return *blocks_[body]; }

private:
  void count() const;
  void discard_evaluated_summaries();
  std::vector<ElementSummary> compute_summaries(std::size_t body, const Vector &displacements,
                                                Beat beat) const;

  const Discretization &discretization_;

  std::vector<std::unique_ptr<ElementBlock>> blocks_; // by body
  // Temperatures by body; null if the body's law does not depend on it.
  std::vector<const Expression *> temperatures_;
  PointStep step_;
  // Summaries by body of the last state whose energies were computed, so that no step computes them
  // twice; empty: unknown.
  std::vector<std::vector<ElementSummary>> summaries_;
  Beat summarized_ = Beat::committed;
  std::size_t n_plastic_ = 0, n_stabilised_ = 0; ///< elements
  HeldMemory plastic_memory_{Capability::plasticity}, stabilised_memory_{Capability::stabilisation};
};

} // namespace billet

#endif
