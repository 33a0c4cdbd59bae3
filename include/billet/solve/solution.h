// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_SOLUTION_H
#define BILLET_SOLVE_SOLUTION_H

#include "billet/contact/contact_load.h"
#include "billet/diagnostics.h"
#include "billet/discretization/discretization.h"
#include "billet/geometry/placement.h"
#include "billet/mechanics/element_block.h"
#include "billet/solve/reactions.h"

#include <vector>

namespace billet {

class MeshErrors;

/// Energies since time 0, the same on all ranks [energy].
struct EnergyLedger {
  double initial = 0.; ///< at the start of the scene
  double kinetic = 0.;
  double elastic = 0.;
  double plastic = 0.;
  double contact = 0.;   ///< stored in penalty springs
  double friction = 0.;  ///< dissipated
  double viscous = 0.;   ///< dissipated by bulk viscosity, and in statics by stabilisation
  double hourglass = 0.; ///< stored by the stabilisation of one-point elements
  double numerical = 0.; ///< dissipated by implicit time integration
  double external = 0.;  ///< work of tools, prescribed displacements and loads

  double total() const {
    return kinetic + elastic + plastic + contact + friction + viscous + hourglass + numerical;
  }
  /// Returns the energy in elements: stored, and dissipated by yielding.
  double of_elements() const { return elastic + plastic + hourglass; }
  double drift() const { return initial + external - total(); }
};

/// State of the scene at the end of an accepted step.
struct SolutionState {
  double time = 0.;
  Vector displacements; ///< ghosted
  Vector velocities;    ///< ghosted; of dynamic scenes, else empty
  std::vector<ContactLoad> tool_loads;
  std::vector<Placement> placements;
  std::vector<ContactLoad> body_pair_loads; ///< on the first body
  EnergyLedger energies;
  dealii::Tensor<1, 3> momentum, angular_momentum; ///< of dynamic scenes, about the origin
};

/// Interface of output to a scene that is being solved.
class Solution {
public:
  virtual ~Solution() = default;
  virtual const SolutionState &state() const = 0;
  /// Returns the mesh of the state.
  virtual const Discretization &discretization() const = 0;
  /// Returns one entry for each owned element of the body, in the order of
  /// Discretization::elements().
  virtual std::vector<ElementSummary> summarize(std::size_t body) const = 0;
  /// Returns the same for the layers; empty if the body has two points through the thickness.
  virtual std::vector<LayerSummaries> summarize_layers(std::size_t) const { return {}; }
  /// Returns averages of the laws' states for the same elements, with layers where the body has
  /// them.
  virtual std::vector<StateAverages> average_states(std::size_t body) const = 0;
  /// Returns the slave nodes on this rank of every contact pair, tools first.
  virtual std::vector<std::vector<ContactNodeReport>> report_contacts() const = 0;
  /// Returns the doubles of history on all ranks: of elements, of contact.
  virtual std::array<std::size_t, 2> history_sizes() const = 0;
  /// Returns the solution method, for the console.
  virtual std::string method() const = 0;
  /// Returns messages about the scene before the first step. Collective.
  virtual DiagnosticList initial_diagnostics() const = 0;
  /// Whether the console shows linear iterations.
  virtual bool solves_iteratively() const { return false; }
  /// Returns the forces on the bodies at the state.
  virtual const Reactions &reactions() const = 0;

  /// Returns the errors of the mesh so far; null if nobody estimates them.
  const MeshErrors *mesh_errors() const { return mesh_errors_; }
  /// Lets mesh_errors() return these, which must outlive the solution.
  void set_mesh_errors(const MeshErrors &errors) { mesh_errors_ = &errors; }

private:
  const MeshErrors *mesh_errors_ = nullptr;
};

} // namespace billet

#endif
