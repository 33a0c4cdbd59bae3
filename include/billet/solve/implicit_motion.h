// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_MOTION_H
#define BILLET_SOLVE_IMPLICIT_MOTION_H

#include "billet/forces/external_loads.h"
#include "billet/forces/inertia.h"
#include "billet/integration/time_integrator.h"
#include "billet/solve/restart.h"
#include "billet/solve/solution.h"
#include "billet/usage.h"

#include <memory>
#include <vector>

namespace billet {

/// What makes of a step of equilibrium one of motion: velocities and accelerations of the bodies and of tools
/// with a mass, their inertia, and loads. QuasiStatic sums up the forces F(u_{n+1}); this turns them into
///   R = F_{n+1} + α_f/(1 − α_f) F_n + M [(1 − α_m) a_{n+1} + α_m a_n]/(1 − α_f),
/// see TimeIntegrator, whatever they are: a further force needs nothing here. The state at the start of the
/// step changes on commit() only.
///
/// Where supports move, velocity and acceleration along their normals are those of the prescribed
/// displacement, by differences over a step: from (I2) they would swing between steps for ever.
class ImplicitMotion {
public:
  /// At time 0, with the initial velocities. Throws InputError.
  ImplicitMotion(const Scene &scene, const Discretization &discretization, const Supports &supports);

  // At the start, and where forces jump, M a = −F has to be solved:
  void add_mass(const TangentSystem &system) const { inertia_.add_tangent(1., system); }
  /// −F − M a of the accelerations that supports prescribe.
  Vector driving_forces(const Vector &forces) const;
  /// The solution, on constrained dofs as well as the homogeneous constraints have it.
  void set_accelerations(const Vector &accelerations);
  /// Of all bodies. Collective.
  double mass() const { return lumped_.l1_norm() / 3.; }
  bool has_mass(const std::size_t tool) const { return tools_[tool].inertia > 0.; }
  /// Of a tool with a mass: what it exerts, and should.
  void start_tool(std::size_t tool, double exerted, double load);

  /// The next steps are those of (I4), in which contact can only take energy; its −F_c at the start of the
  /// step. Collective.
  void damp_contact(const Vector &contact_forces);
  /// They are not any more.
  void release_contact() { damps_contact_ = false; }
  bool damps_contact() const { return damps_contact_; }
  /// The weight of contact's forces, and of their tangent, in R.
  double contact_weight() const { return damps_contact_ ? integrator_.contact() : 1.; }
  /// With (I4), before step_error() and commit(): −F_c at the end of the step. Collective.
  void finish_contact(const Vector &contact_forces);

  /// The step from t_n to t, from these displacements and offsets of the tools.
  void start_step(double t_n, double t, const Vector &displacements, const std::vector<double> &offsets);
  /// Adds what they change by at constant acceleration.
  void extrapolate(Vector &displacements, std::vector<double> &offsets) const;

  /// Adds the loads' −F at these displacements at the end of the step, or at the start of the run. Returns
  /// their norm. Collective.
  double add_loads(double t, const Vector &displacements, Vector &residual);
  /// Makes R of the sum of all forces, after add_loads(). Returns the norm of the inertia forces. Nothing at
  /// the start of the run.
  double complete(const Vector &forces_n, Vector &residual) const;
  /// Adds ∂R/∂u of loads and inertia. The system's constraints are homogeneous: accelerations of held nodes
  /// do not depend on u.
  void add_tangent(double t, const TangentSystem &system) const;
  /// The same for a tool's offset: what there is beside the weighted force that it exerts and its load, and
  /// the slope of that.
  double tool_inertia(std::size_t tool, double offset) const;
  double tool_slope(std::size_t tool) const;
  /// The residual that round-off in the displacements makes [force].
  double round_off_force() const { return round_off_force_; }
  /// By what the tolerances of iterations are multiplied: where the user wants smaller errors of steps than
  /// by default what iterations leave must not be as large as these.
  double wanted_accuracy() const;

  /// Error of the step's time integration as part of what is allowed, at the last add_loads(); 0 if nothing
  /// is asked for.
  double step_error(const Vector &displacements) const;

  /// The state of the last add_loads() becomes the start of the next step; works are booked in `energies`.
  /// `mean_forces`: F over the step.
  void commit(const Vector &displacements, const Vector &increment, const Vector &mean_forces,
              EnergyLedger &energies);
  /// `exerted` on the bodies along the tool's direction, or about its axis.
  void commit_tool(std::size_t tool, double offset, double exerted, double load, EnergyLedger &energies);
  /// It goes with its mass; returns its kinetic energy.
  double remove_tool(std::size_t tool);
  /// Velocities, kinetic energy and momenta.
  void update_state(SolutionState &state) const;

  /// The state at the start of the step; that of a tool into the tool's group.
  void save(StateWriter &writer, const OwnedNodes &nodes) const;
  void load(const StateReader &reader, const OwnedNodes &nodes);
  void save_tool(std::size_t tool, StateWriter &writer) const;
  /// `is_exact`: with accelerations, which have to be found anew else.
  void load_tool(std::size_t tool, const StateReader &reader, bool is_exact);
  /// In place of load(), at time t of another method's state: with its velocities, if it has some, else the
  /// initial ones.
  void begin(const StateReader &reader, const OwnedNodes &nodes, double t);

private:
  /// Of a tool with a mass: offset, rate and forces at the start of the step.
  struct HeavyTool {
    double inertia = 0.; ///< 0: none
    double offset = 0., rate = 0., acceleration = 0., exerted = 0., load = 0.;
  };
  /// Rates of the held components, other components 0.
  struct HeldRates {
    Vector velocity, acceleration;
  };
  HeldRates find_held_rates(double t, double step) const;
  /// What the supports' values change by, other components 0.
  Vector held_change(double from, double to) const;
  void set_rates(const Vector &displacements);
  double accelerate(const HeavyTool &tool, double offset) const;
  /// a_n, or with (I4) that of the other forces.
  const Vector &start_accelerations() const { return damps_contact_ ? a_bare_ : a_n_; }
  double start_acceleration(const HeavyTool &tool) const {
    return tool.acceleration + (damps_contact_ ? tool.exerted / tool.inertia : 0.);
  }
  /// Those at the end of the step, all in all.
  Vector end_accelerations() const;
  /// c = −M⁻¹ F of these forces. Collective.
  Vector accelerations_by(const Vector &forces) const;
  Vector ghosted(const Vector &owned) const;
  double mean_size(const Vector &field) const;
  /// Of a body, about the mean of the field over its mass.
  struct Spread {
    double square; ///< Σ m x²
    double mass;
  };
  std::vector<Spread> spread_of_bodies(const Vector &field) const;
  /// What the error tolerance is a part of, (I7): the displacements, root mean square over the mass. How far
  /// bodies have gone together counts up to the largest one's radius of gyration: a long flight makes the
  /// impact at its end no larger.
  double displacement_to_resolve(const Vector &displacements) const;
  NodalVectors nodal(const Vector &field) const;

  const Scene &scene_;
  const Discretization &discretization_;
  const Supports &supports_;
  const parameters::ImplicitDynamics &parameters_;
  TimeIntegrator integrator_;
  LocalNodes nodes_;
  Inertia inertia_;
  HeldMemory inertia_memory_{Capability::inertia}, error_memory_{Capability::error_control};
  std::unique_ptr<ExternalLoads> loads_; ///< none where there are none
  std::vector<HeavyTool> tools_;

  double t_n_ = 0., step_ = 0.; ///< of the step that is tried; 0: none yet
  Vector u_n_, v_n_, a_n_, v_, a_;
  // With (I4) a_ is a*:
  bool damps_contact_ = false;
  Vector c_;                           ///< at the end of the step
  Vector a_bare_;                      ///< a_n, without what contact adds
  Vector lumped_;                      ///< row sums of the mass
  Vector load_forces_n_, load_forces_; ///< F
  NodalVectors displaced_;             ///< at the last add_loads()
  HeldRates held_n_, held_;
  Vector held_change_;
  double round_off_force_ = 0., largest_displacement_ = 0., largest_gyration_ = 0.;
  struct BodyAxis {
    std::size_t body;
    unsigned int axis;
  };
  std::vector<BodyAxis> body_axes_; ///< of owned dofs
};

} // namespace billet

#endif
