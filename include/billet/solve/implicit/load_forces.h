// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_LOAD_FORCES_H
#define BILLET_SOLVE_IMPLICIT_LOAD_FORCES_H

#include "billet/forces/external_loads.h"
#include "billet/forces/inertia.h"
#include "billet/solve/load_works.h"
#include "billet/solve/restart.h"

#include <functional>
#include <memory>
#include <vector>

namespace billet {

/// Forces of the loads of a scene on owned dofs, at the start and the end of a step.
class LoadForces {
public:
  /// `masses` returns this rank's shares of the nodal masses, and is called if there are loads.
  LoadForces(const Scene &scene, const Discretization &discretization, const LocalNodes &nodes,
             const std::function<std::vector<double>(const LocalNodes &)> &masses);

  /// Subtracts the forces at these displacements and velocities from the residual. Returns their
  /// norm. Collective.
  double subtract(double t, const Vector &displacements, const Vector &velocities, Vector &residual);
  /// Adds the derivatives, after subtract(); `damping_factor` as TimeIntegrator's.
  void add_tangent(double t, double damping_factor, const TangentSystem &system) const;
  /// Returns the forces at the start of the step.
  const Vector &at_start() const { return forces_n_; }
  /// Makes the forces of the last subtract() those at the start of the step.
  void start();
  /// Whether the force of a load jumps at t, the end of a step.
  bool jump_at(const double t) const { return loads_ != nullptr && loads_->works.jumps_at(t); }
  /// Begins the next step with the loads that act after t, at the displacements of the last
  /// subtract() and these velocities. Returns their forces less those of the last subtract().
  /// Collective.
  Vector start_after(double t, const Vector &velocities);
  /// Does the same as start() after a step. Returns the work of the forces, by the trapezoidal
  /// rule.
  double commit(const Vector &increment);

  /// Returns force and work of each load at the start of the step. Collective.
  std::vector<LoadResult> results() const;

  void save(StateWriter &writer, const OwnedNodes &nodes) const;
  void load(const StateReader &reader, const OwnedNodes &nodes);

private:
  struct Loads {
    Loads(const Scene &scene, const LocalNodes &nodes, std::vector<double> masses)
        : all(scene, nodes, std::move(masses)), works(scene, nodes, all) {}

    ExternalLoads all;
    LoadWorks works;
    double time = 0.; ///< of the last subtract()
  };
  NodalVectors nodal(const Vector &field) const;
  /// Returns the sums over all ranks of forces at the nodes. Collective.
  Vector sum_of(const NodalVectors &forces) const;

  const Discretization &discretization_;
  const LocalNodes &nodes_;
  std::unique_ptr<Loads> loads_;   ///< null without loads
  Vector forces_n_, forces_;       ///< F
  NodalVectors displaced_, rates_; ///< at the last subtract()
};

} // namespace billet

#endif
