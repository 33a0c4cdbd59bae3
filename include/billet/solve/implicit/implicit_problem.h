// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_IMPLICIT_PROBLEM_H
#define BILLET_SOLVE_IMPLICIT_IMPLICIT_PROBLEM_H

#include "billet/forces/internal_forces.h"
#include "billet/solve/implicit/body_stabilisation.h"
#include "billet/solve/implicit/driven_tools.h"
#include "billet/solve/implicit/implicit_motion.h"
#include "billet/solve/implicit/step_state.h"
#include "billet/solve/implicit/switched_supports.h"
#include "billet/solve/implicit/tangent_matrix.h"
#include "billet/solve/implicit/tool_removal.h"
#include "billet/solve/newton.h"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace billet {

/// Forces of an implicit scene, the objects that they act on, and the tangent matrix; built once.
class ImplicitParts {
public:
  ImplicitParts(const Scene &scene, const Discretization &discretization);
  ~ImplicitParts();

  const Scene &scene() const { return scene_; }
  const parameters::Scene &parameters() const { return scene_.parameters(); }
  const Discretization &discretization() const { return discretization_; }
  MPI_Comm communicator() const { return discretization_.communicator(); }

  const Supports &supports() const { return supports_.get(); }
  SwitchedSupports &switched_supports() { return supports_; }
  const SwitchedSupports &switched_supports() const { return supports_; }
  InternalForces &internal() { return internal_; }
  const InternalForces &internal() const { return internal_; }
  ContactSet &contacts() { return contacts_; }
  const ContactSet &contacts() const { return contacts_; }
  ImplicitScheme &scheme() { return motion_ ? *motion_ : *statics_; }
  const ImplicitScheme &scheme() const { return motion_ ? *motion_ : *statics_; }
  /// Returns the motion; null in statics.
  ImplicitMotion *motion() { return motion_.get(); }
  DrivenTools &tools() { return tools_; }
  const DrivenTools &tools() const { return tools_; }
  ToolRemoval &removal() { return removal_; }
  const ToolRemoval &removal() const { return removal_; }
  ReleasedForces &released() { return released_; }
  const ReleasedForces &released() const { return released_; }
  BodyStabilisation &stabilisation() { return stabilisation_; }
  const BodyStabilisation &stabilisation() const { return stabilisation_; }
  TangentMatrix &tangent() { return tangent_; }
  const TangentMatrix &tangent() const { return tangent_; }

private:
  const Scene &scene_;
  const Discretization &discretization_;
  SwitchedSupports supports_;
  InternalForces internal_;
  ContactSet contacts_;
  std::unique_ptr<ImplicitScheme> statics_; ///< null in dynamics
  std::unique_ptr<ImplicitMotion> motion_;  ///< null in statics
  DrivenTools tools_;
  ToolRemoval removal_;
  ReleasedForces released_;
  BodyStabilisation stabilisation_;
  TangentMatrix tangent_;
};

/// Balance of all forces at the end of a step, R = F_int − F_c + ... = 0, as one nonlinear problem:
/// sums up its parts(). Evaluations never change the state at the start of the step.
class ImplicitProblem final : public NonlinearProblem {
public:
  ImplicitProblem(const Scene &scene, const Discretization &discretization);
  ~ImplicitProblem() override;

  ImplicitParts &parts() { return parts_; }
  const ImplicitParts &parts() const { return parts_; }
  StepState &step() { return step_; }
  const StepState &step() const { return step_; }
  ForceScales &scales() { return scales_; }
  const ForceScales &scales() const { return scales_; }
  /// Returns the state at the end of the last accepted step.
  SolutionState &state() { return state_; }
  const SolutionState &state() const { return state_; }

  /// Places the tools at time `t`; residuals and tangents are those of the step that ends there.
  void start_step(double t);
  /// Begins a step of zero length at the last accepted state; tools stay in place.
  void start_at_rest();
  /// Computes all forces at the start of the step. Collective.
  void evaluate_start();
  /// Makes the forces of the trial state those at the start of the step, and sets the loads of
  /// contacts in state(). Returns these loads. Collective.
  Contacts::Loads start_from_trial();
  /// Return the unknowns, displacements and offsets of driven tools, at the start of the step and
  /// in the trial state.
  Vector unknowns() const {
    return parts_.tools().pack(step_.start.displacements, parts_.tools().start_offsets());
  }
  Vector trial_unknowns() const {
    return parts_.tools().pack(step_.trial.displacements, parts_.tools().offsets());
  }
  void set_trial(const Vector &x);

  bool compute_residual(const Vector &x, Vector &residual) override;
  bool compute_tangent(const Vector &x) override;
  bool solve_tangent(const Vector &residual, Vector &dx, double relative_tolerance) override;
  double max_step_length(const Vector &x, const Vector &direction) override;
  double force_scale() const override { return scales_.force; }
  double round_off_force() const override { return scales_.round_off + parts_.scheme().round_off_force(); }
  double contact_round_off_force() const override {
    return scales_.contact_bears ? scales_.spring_round_off : 0.;
  }
  StatusChanges status_changes() const override { return status_changes_; }

  /// Assembles the tangent at the trial state. `yield_slack`: see HenckyPlasticity::update().
  bool assemble_tangent(const TangentSystem &system, double yield_slack = 0.);
  /// Solves the bordered system; see DrivenTools::solve().
  bool solve_bordered(const Vector &r_u, const std::vector<double> &r_s, double sense,
                      double relative_tolerance, Vector &du, std::vector<double> &ds);
  bool on_all_ranks(bool success) const;
  /// Returns the part of the motion from the start of the step to the trial state in which no node
  /// passes through anything. If it is below 1, obstacle() describes the passage. Collective.
  double find_free_part(bool is_thorough);
  const std::string &obstacle() const { return obstacle_; }
  void clear_obstacle() { obstacle_.clear(); }
  /// Sets a function that judges each trial state after its contacts are known. It returns why the
  /// state is not admissible; empty if it is. Collective.
  void judge_trials(std::function<std::string()> judge) { judge_ = std::move(judge); }

private:
  /// Compares the contacts with those at the last tangent. Collective.
  StatusChanges find_status_changes() const;

  ImplicitParts parts_;
  StepState step_;
  ForceScales scales_;
  SolutionState state_;
  Vector raw_internal_, raw_contact_;               ///< additive
  std::vector<std::vector<SlaveForce>> linearised_; ///< of the contacts at the last tangent
  /// Changes between the last tangent and the last residual.
  StatusChanges status_changes_;
  std::string obstacle_;
  std::function<std::string()> judge_; ///< of trial states; may be empty
};

} // namespace billet

#endif
