// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_IMPLICIT_MOTION_H
#define BILLET_SOLVE_IMPLICIT_IMPLICIT_MOTION_H

#include "billet/solve/implicit/free_mass.h"
#include "billet/solve/implicit/heavy_tools.h"
#include "billet/solve/implicit/load_forces.h"
#include "billet/solve/implicit/motion_error.h"
#include "billet/solve/implicit/scheme.h"
#include "billet/solve/implicit/support_rates.h"

#include <vector>

namespace billet {

/// Implicit dynamics: velocities and accelerations of the bodies and of tools with a mass, their
/// inertia, and loads. From the sum of all forces F(u_{n+1}) it computes
///   R = F_{n+1} + α_f/(1 − α_f) F_n + M [(1 − α_m) a_{n+1} + α_m a_n]/(1 − α_f),
/// see TimeIntegrator. New kinds of forces need no change here. The state at the start of the step
/// changes on commit() only.
///
/// Where supports move, velocity and acceleration along their normals are those of the prescribed
/// displacement, by differences over a step. With (I2) they would oscillate between steps
/// permanently.
class ImplicitMotion final : public ImplicitScheme {
public:
  /// Starts at time 0, with the initial velocities. Throws InputError.
  ImplicitMotion(const Scene &scene, const Discretization &discretization, const Supports &supports);
  ~ImplicitMotion() override;

  parameters::TimeStepping::Scheme kind() const override {
    return parameters::TimeStepping::Scheme::implicit_dynamics;
  }
  bool has_inertia() const override { return true; }
  double mass() const override { return mass_.row_sums().l1_norm() / 3.; }
  double wanted_accuracy() const override { return error_.wanted_accuracy(); }
  double round_off_force() const override { return step_.round_off_force; }

  // At the start, and where forces jump, M a = −F has to be solved:
  void add_mass(const TangentSystem &system) const { mass_.inertia().add_tangent(1., system); }
  /// Returns −F − M a for the accelerations that supports prescribe.
  Vector driving_forces(const Vector &forces) const;
  /// Sets the solution of these equations. On constrained dofs it satisfies the homogeneous
  /// constraints.
  void set_accelerations(const Vector &accelerations);

  /// Returns the weights of contact. Before step_error() and commit() they have to be finished.
  ContactDamping &contact() override { return damping_; }
  const ContactDamping &contact() const override { return damping_; }
  HeavyTools &tools() override { return tools_; }
  const HeavyTools &tools() const override { return tools_; }

  void start_step(double t_n, double t, const Vector &displacements,
                  const std::vector<double> &offsets) override;
  /// Adds the changes of displacements and offsets at constant acceleration.
  void extrapolate(Vector &displacements, std::vector<double> &offsets) const;
  double add_loads(double t, const Vector &displacements, Vector &residual) override;
  /// Completes the residual after add_loads(); adds no inertia at the start of the run.
  double complete(const Vector &contact, Vector &residual) const override;
  double residual_weight() const override { return 1. / (1. + integrator_.forces_before()); }
  /// Adds the tangent. The system's constraints are homogeneous: accelerations of constrained nodes
  /// do not depend on u.
  void add_tangent(double t, const TangentSystem &system) const override;
  /// Returns the error of the step's time integration over the allowed one, at the last
  /// add_loads(); 0 without an 'Error tolerance'.
  double step_error(const Vector &displacements) const;

  /// Begins the next step with the loads that act after t, if loads jump there or if velocities do.
  /// Then `forces`, the sum of all forces with the sign of the residual, changes with them. The
  /// accelerations have to be computed anew, and it returns true. Collective.
  bool follow_loads(double t, bool velocities_jump, Vector &forces);
  void add_end_inertia(Vector &residual) const override;

  /// Follows supports that have begun or ended at t: nodes of new ones take their velocities at
  /// once. Returns the work that this does. The accelerations have to be computed anew. Collective.
  double follow_supports(double t);

  /// Makes the state of the last add_loads() the start of the next step.
  std::vector<LoadResult> commit(const Vector &displacements, const Vector &increment,
                                 const Vector &mean_forces, double touching, EnergyLedger &energies) override;
  void update_state(SolutionState &state) const override;

  void save(StateWriter &writer, const OwnedNodes &nodes) const override;
  void load(const StateReader &reader, const OwnedNodes &nodes) override;
  /// Replaces load() at time t of another method's state. Takes its velocities if it has some, else
  /// the initial ones.
  void begin(const StateReader &reader, const OwnedNodes &nodes, double t);

private:
  struct Rates {
    Vector velocity, acceleration;
  };
  /// The step that is tried.
  struct TrialStep {
    double t_n = 0., length = 0.; ///< length 0: none yet [time]
    Vector u_n;                   ///< displacements at its start [length]
    double round_off_force = 0.;  ///< what the last bits of displacements do to inertia [force]
  };
  void set_rates(const Vector &displacements);
  /// Returns the accelerations at the end of the step, including contact.
  Vector end_accelerations() const;

  const Scene &scene_;
  const Discretization &discretization_;
  const Supports &supports_;
  TimeIntegrator integrator_;
  LocalNodes nodes_;
  FreeMass mass_;
  Rates start_, trial_;
  ContactDamping damping_;
  HeavyTools tools_;
  LoadForces loads_;
  SupportRates held_;
  MotionError error_;
  TrialStep step_;
  HeldMemory memory_{Capability::inertia};
};

} // namespace billet

#endif
