// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_SCHEME_H
#define BILLET_SOLVE_IMPLICIT_SCHEME_H

#include "billet/discretization/supports.h"
#include "billet/parameters/control.h"
#include "billet/solve/implicit/contact_weights.h"
#include "billet/solve/implicit/step_state.h"
#include "billet/solve/implicit/tool_inertia.h"
#include "billet/solve/restart.h"
#include "billet/solve/solution.h"

#include <vector>

namespace billet {

/// Contributions of time to the sum of all forces in a step: inertia, loads and the weights of a
/// time integrator. Here weights are one, and inertia and loads are zero. Statics adds loads;
/// ImplicitMotion is implicit dynamics. This class adds to the sum and advances; contact() weighs
/// the forces of contact in it, and tools() have the inertia of driven tools.
class ImplicitScheme {
public:
  ImplicitScheme() = default;
  virtual ~ImplicitScheme() = default;
  ImplicitScheme(const ImplicitScheme &) = delete;
  ImplicitScheme &operator=(const ImplicitScheme &) = delete;

  /// Returns the scheme, whose name checkpoints store.
  virtual parameters::TimeStepping::Scheme kind() const {
    return parameters::TimeStepping::Scheme::quasi_static;
  }
  /// Whether inertia resists motions that neither supports nor contact resist.
  virtual bool has_inertia() const { return false; }
  /// Returns the mass of all bodies. Collective.
  virtual double mass() const { return 0.; }
  /// Returns the factor of the iterations' tolerances.
  virtual double wanted_accuracy() const { return 1.; }
  /// Returns the residual by round-off in inertia [force].
  virtual double round_off_force() const { return 0.; }

  // Roles.

  virtual ContactWeights &contact() { return equal_weights_; }
  virtual const ContactWeights &contact() const { return equal_weights_; }
  virtual ToolInertia &tools() { return no_inertia_; }
  virtual const ToolInertia &tools() const { return no_inertia_; }

  // Steps.

  /// Begins the step from t_n to t, from these displacements and offsets of the tools.
  virtual void start_step(double /*t_n*/, double /*t*/, const Vector & /*displacements*/,
                          const std::vector<double> & /*offsets*/) {}
  /// Subtracts the loads at the end of the step from the residual. Returns their norm. Collective.
  virtual double add_loads(double /*t*/, const Vector & /*displacements*/, Vector & /*residual*/) {
    return 0.;
  }
  /// Adds the change of the loads in the step, at these displacements at its start. Returns false
  /// without loads, and where a predictor needs none. Collective.
  virtual bool add_load_change(double /*t*/, const Vector & /*displacements*/, Vector & /*forces*/) {
    return false;
  }
  /// Begins the next step from the loads of the last add_loads(), after a restart.
  virtual void start_loads() {}
  /// Completes the sum of all forces to the residual; `contact` is the part of contact. Returns the
  /// norm of the inertia forces.
  virtual double complete(const Vector & /*contact*/, Vector & /*residual*/) const { return 0.; }
  /// Adds the forces of inertia at the end of the step to the sum of all forces there, with the
  /// accelerations of all forces.
  virtual void add_end_inertia(Vector & /*residual*/) const {}
  /// Returns the factor of the residual that makes the weights of its forces at both ends of the
  /// step sum up to one.
  virtual double residual_weight() const { return 1.; }
  /// Adds the derivatives of loads and inertia.
  virtual void add_tangent(double /*t*/, const TangentSystem &) const {}

  /// Accepts the step, with its increment and mean forces, and records their works. `touching` is
  /// the work of springs in contact, see StepWorks. Returns force and work of each load.
  /// Collective.
  virtual std::vector<LoadResult> commit(const Vector & /*displacements*/, const Vector &increment,
                                         const Vector &mean_forces, const double touching,
                                         EnergyLedger &energies) {
    energies.external += mean_forces * increment + touching;
    return {};
  }
  /// Sets velocities, kinetic energy and momenta.
  virtual void update_state(SolutionState &) const {}

  /// Saves the state at the start of the step, except that of tools.
  virtual void save(StateWriter &, const OwnedNodes &) const {}
  virtual void load(const StateReader &, const OwnedNodes &) {}

private:
  ContactWeights equal_weights_;
  ToolInertia no_inertia_;
};

} // namespace billet

#endif
