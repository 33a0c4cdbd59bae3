// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_MOTION_H
#define BILLET_SOLVE_IMPLICIT_MOTION_H

#include "billet/forces/external_loads.h"
#include "billet/forces/inertia.h"
#include "billet/integration/time_integrator.h"
#include "billet/solve/implicit/scheme.h"
#include "billet/usage.h"

#include <memory>
#include <vector>

namespace billet {

/// Implicit dynamics: velocities and accelerations of the bodies and of tools with a mass, their inertia, and
/// loads. Of the sum of all forces F(u_{n+1}) it makes
///   R = F_{n+1} + α_f/(1 − α_f) F_n + M [(1 − α_m) a_{n+1} + α_m a_n]/(1 − α_f),
/// see TimeIntegrator, whatever they are: a further force needs nothing here. The state at the start of the
/// step changes on commit() only.
///
/// Where supports move, velocity and acceleration along their normals are those of the prescribed
/// displacement, by differences over a step: from (I2) they would swing between steps for ever.
class ImplicitMotion final : public ImplicitScheme {
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
  double mass() const override { return lumped_.l1_norm() / 3.; }
  std::string name() const override { return "implicit dynamics"; }
  bool has_inertia() const override { return true; }
  bool has_mass(const std::size_t tool) const override { return tools_[tool].inertia > 0.; }
  /// Of a tool with a mass: what it exerts, and should.
  void start_tool(std::size_t tool, double exerted, double load);

  /// Once damped by (I4), steps stay so until contacts have opened.
  void choose_contact_damping(const ForceState &start) override;
  /// The next steps are those of (I4), in which contact can only take energy.
  void damp_contact(const ForceState &start) override;
  bool damps_contact() const { return damps_contact_; }
  double contact_weight() const override { return damps_contact_ ? integrator_.contact() : 1.; }
  double contact_before() const override { return damps_contact_ ? 0. : 0.5; }
  /// With (I4), before step_error() and commit(): −F_c at the end of the step. Collective.
  void finish_contact(const Vector &contact_forces);

  void start_step(double t_n, double t, const Vector &displacements,
                  const std::vector<double> &offsets) override;
  /// Adds what they change by at constant acceleration.
  void extrapolate(Vector &displacements, std::vector<double> &offsets) const;

  double add_loads(double t, const Vector &displacements, Vector &residual) override;
  /// After add_loads(). Nothing at the start of the run.
  double complete(const Vector &contact, Vector &residual) const override;
  /// The system's constraints are homogeneous: accelerations of held nodes do not depend on u.
  void add_tangent(double t, const TangentSystem &system) const override;
  /// What there is beside the weighted force that the tool exerts and its load, and the slope of that.
  double tool_inertia(std::size_t tool, double offset) const override;
  double tool_slope(std::size_t tool) const override;
  double round_off_force() const override { return round_off_force_; }
  /// Where the user wants smaller errors of steps than by default what iterations leave must not be as large
  /// as these.
  double wanted_accuracy() const override;

  /// Error of the step's time integration as part of what is allowed, at the last add_loads(); 0 if nothing
  /// is asked for.
  double step_error(const Vector &displacements) const;

  /// The state of the last add_loads() becomes the start of the next step.
  void commit(const Vector &displacements, const Vector &increment, const Vector &mean_forces,
              double touching, EnergyLedger &energies) override;
  /// `exerted` on the bodies along the tool's direction, or about its axis.
  void commit_tool(std::size_t tool, double offset, double exerted, double load,
                   EnergyLedger &energies) override;
  double remove_tool(std::size_t tool) override;
  void update_state(SolutionState &state) const override;

  void save(StateWriter &writer, const OwnedNodes &nodes) const override;
  void load(const StateReader &reader, const OwnedNodes &nodes);
  void save_tool(std::size_t tool, StateWriter &writer) const override;
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
  Vector bare_forces_n_;               ///< F_n of the residual: all forces, or with (I4) without contact
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
