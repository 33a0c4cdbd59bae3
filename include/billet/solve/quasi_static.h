// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_QUASI_STATIC_H
#define BILLET_SOLVE_QUASI_STATIC_H

#include "billet/contact/rigid_contact.h"
#include "billet/forces/internal_forces.h"
#include "billet/solve/direct_solver.h"
#include "billet/solve/newton.h"

#include <memory>
#include <vector>

namespace billet {

/// Energies since time 0, on all ranks the same [energy].
struct EnergyLedger {
  double elastic = 0.;
  double plastic = 0.;
  double contact = 0.;  ///< stored in penalty springs
  double friction = 0.; ///< dissipated
  double external = 0.; ///< work of tools and prescribed displacements
  double drift() const { return external - elastic - plastic - contact - friction; }
};

/// Where the scene stands at the end of an accepted step.
struct SolutionState {
  double time = 0.;
  Vector displacements; ///< ghosted
  std::vector<ContactLoad> tool_loads;
  std::vector<Placement> placements;
  EnergyLedger energies;
};

/// Equilibrium of all forces, R = F_int − F_c = 0, step by step: the sum of the parts as one nonlinear
/// problem, with commit on acceptance and nothing to undo on failure, since the state at the start of a step
/// is never written to.
class QuasiStatic final : public NonlinearProblem {
public:
  QuasiStatic(const Scene &scene, const Discretization &discretization);

  /// Tries the step from the current time to `t`. On convergence the new state is committed. `previous_step`
  /// is the length of the last accepted step if its increment may be continued, 0 else.
  NewtonReport step(double t, double previous_step);

  /// Moves the tools to where they are at `t`; residuals and tangents are those of the step that ends there.
  void start_step(double t);

  const SolutionState &state() const { return state_; }
  const InternalForces &internal_forces() const { return internal_; }
  const std::vector<RigidContact> &contacts() const { return contacts_; }
  const Supports &supports() const { return supports_; }
  std::string linear_solver_name() const { return direct_->name(); }
  /// Doubles of history on all ranks: of elements, of contact.
  std::array<std::size_t, 2> history_sizes() const;

  bool compute_residual(const Epetra_Vector &x, Epetra_Vector &residual) override;
  bool compute_tangent(const Epetra_Vector &x) override;
  bool solve_tangent(const Epetra_Vector &residual, Epetra_Vector &dx) override;
  double force_scale() const override { return force_scale_; }
  double round_off_force() const override { return round_off_force_; }

private:
  void build_matrix();
  // First guesses of a step, into trial_. The last increment, continued; false where tools or supports change
  // their pace:
  bool continue_increment(double t, double previous_step);
  // one linear step from the last state, into which the motion of tools and supports is put; false where it
  // has no solution:
  bool follow_tangent(double t, NewtonIteration &iteration);

  bool assemble_tangent(const TangentSystem &system);
  bool all_ranks(bool success) const;
  void set_trial(const Epetra_Vector &x);
  void commit(double t);
  /// Folds forces on constrained dofs into those that they depend on, and empties them.
  void condense(Vector &forces) const;

  const Scene &scene_;
  const Discretization &discretization_;
  Supports supports_;
  InternalForces internal_;
  std::vector<RigidContact> contacts_;

  Matrix matrix_;
  std::unique_ptr<DirectSolver> direct_;

  Vector trial_, trial_ghosted_, u_n_, last_increment_;
  Vector raw_internal_, raw_contact_;        ///< additive
  Vector support_forces_, support_forces_n_; ///< residual before constraints: what the supports exert
  double force_scale_ = 0., round_off_force_ = 0.;
  SolutionState state_;
};

} // namespace billet

#endif
