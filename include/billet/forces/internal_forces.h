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

  /// Begins a step of this length [time]; of zero where the state at the start is to be evaluated.
  void start_step(const double dt) { step_.dt = dt; }

  /// Adds the forces [force] to `forces` (additive vector). False if an element on this rank is not
  /// admissible.
  bool assemble_forces(const Vector &displacements, Vector &forces);

  /// Adds the tangent [force/length]. False as above. `yield_slack`: see PointStep.
  bool assemble_tangent(const Vector &displacements, const TangentSystem &system, double yield_slack = 0.);

  /// The state of the last assembly becomes the start of the next step.
  void commit();

  struct Energies {
    double elastic = 0.;
    double plastic = 0.;
    double hourglass = 0.; ///< stored by the stabilisation
    double total() const { return elastic + plastic + hourglass; }
  };
  /// At a history and the displacements that belong to it; on all ranks the same.
  Energies compute_energies(const Vector &displacements, Beat beat = Beat::committed) const;

  /// One entry for each owned element of the body, in the order of Discretization::elements().
  std::vector<ElementSummary> summarize(std::size_t body, const Vector &displacements,
                                        Beat beat = Beat::committed) const;

  /// The same of the layers; empty if the body has two points through the thickness.
  std::vector<LayerSummaries> summarize_layers(std::size_t body, const Vector &displacements) const;

  /// Doubles of history on this rank.
  std::size_t history_size() const;

  /// For checkpoints.
  ElementBlock &block(const std::size_t body) { return *blocks_[body]; }
  const ElementBlock &block(const std::size_t body) const { return *blocks_[body]; }

private:
  const Discretization &discretization_;
  void count() const;

  std::vector<std::unique_ptr<ElementBlock>> blocks_; // by body
  PointStep step_;
  std::size_t n_plastic_ = 0, n_stabilised_ = 0; ///< elements
  HeldMemory plastic_memory_{Capability::plasticity}, stabilised_memory_{Capability::stabilisation};
};

} // namespace billet

#endif
