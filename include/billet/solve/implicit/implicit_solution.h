// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_IMPLICIT_SOLUTION_H
#define BILLET_SOLVE_IMPLICIT_IMPLICIT_SOLUTION_H

#include "billet/solve/element_points.h"
#include "billet/solve/implicit/accepted_steps.h"
#include "billet/solve/implicit/implicit_reactions.h"
#include "billet/solve/implicit/problem_checkpoint.h"
#include "billet/solve/implicit/step_attempt.h"
#include "billet/solve/implicit/step_diagnosis.h"
#include "billet/solve/solution.h"

#include <memory>
#include <string>
#include <vector>

namespace billet {

/// Solution of a static or an implicit dynamic scene, step by step: attempts a step, recovers from
/// failures, and commits the step on acceptance. A failure needs no undo, since the state at the
/// start of a step never changes before.
class ImplicitSolution final : public Solution, public HasElementPoints {
public:
  ImplicitSolution(const Scene &scene, const Discretization &discretization);
  ~ImplicitSolution() override;

  /// Tries the step from the current time to `t`. On convergence the new state is committed.
  /// `previous_step` is the length of the last accepted step if its increment may be continued,
  /// else 0. Throws SolutionFailure, on all ranks, if the removal of tools has left a body free.
  NewtonReport step(double t, double previous_step);

  using Results = StepResults::Groups;
  /// Returns the results that steps are judged by, with their names.
  StepResults results() const { return StepResults(problem_); }

  /// Step that is tried but not accepted.
  struct Probe {
    NewtonReport newton;
    Results results; ///< at its end
  };
  /// Tries the step to `t`, and leaves the state unchanged. The next steps up to `t` begin their
  /// iterations from its solution.
  Probe probe(double t, double previous_step);

  /// Returns the measurement of the error of the results by penetration, which the next accepted
  /// step makes if it is asked to.
  PenetrationMeasurement &measurement() { return measurement_; }
  /// Returns the deepest penetration of the last accepted step, over the 'Penetration tolerance',
  /// or over 1e-5 facets in pairs without one.
  double penetration() const { return penetration_; }
  /// Sets the factor of the pairs' tolerances above which tractions are augmented. A remaining
  /// penetration above that is an error to be reported, and fails no step.
  void set_penetration_allowed(const double factor) {
    augmentation_.allow_penetration(factor);
    augmentation_.may_leave_penetration();
  }
  /// Sets the factor of the tolerances of residuals and their work; in (0, 1].
  void set_accuracy(const double factor) { solver_.set_accuracy(factor); }
  /// Lets the step that failed, and shorter ones, begin with low penalties until one is accepted.
  /// Returns false if they already could, or the scheme does without.
  bool take_low_penalties() { return rules_->may_continue_penalties() && continuation_.permit_low(); }

  /// Returns the time error of the last step that was tried, and where the energies do not balance.
  const EnergyBalance &balance() const { return rules_->balance(); }

  const SolutionState &state() const override { return problem_.state(); }
  const Discretization &discretization() const override { return parts_.discretization(); }
  std::vector<ElementSummary> summarize(std::size_t body) const override {
    return parts_.internal().summarize(body, state().displacements);
  }
  std::vector<LayerSummaries> summarize_layers(std::size_t body) const override {
    return parts_.internal().summarize_layers(body, state().displacements);
  }
  std::vector<StateAverages> average_states(std::size_t body) const override {
    return parts_.internal().average_states(body);
  }
  std::vector<ElementPoints> element_points(std::size_t body) const override;
  std::vector<std::vector<ContactNodeReport>> report_contacts() const override {
    return parts_.contacts().report();
  }
  std::array<std::size_t, 2> history_sizes() const override;
  std::string method() const override { return parts_.tangent().solver().name(); }
  DiagnosticList initial_diagnostics() const override;
  bool solves_iteratively() const override { return parts_.tangent().solver().is_iterative(); }
  const Reactions &reactions() const override { return reactions_.values(); }

  /// Returns messages at the end of the run. They concern stabilised bodies, contact that has lost
  /// or generated energy in total, round-off of penalties, and augmentation that was given up.
  /// Collective.
  DiagnosticList finish() const;

  /// Returns the equation of the steps.
  ImplicitProblem &equation() { return problem_; }
  const ImplicitProblem &equation() const { return problem_; }
  /// Returns PenaltyWatch::has_low_penalties().
  bool has_low_penalties() const { return books_.has_low_penalties(); }

  /// Saves the state at the end of the last accepted step.
  void save(StateWriter &writer) const;
  /// Resumes from such a state, instead of starting at time 0. From the state of another method it
  /// takes displacements and stresses, and, in dynamic scenes, velocities. A static scene that has
  /// other tools or pairs, or a state from elsewhere, is out of balance. The imbalance fades over
  /// `release_time`, or, if that is 0, until the end time. In dynamic scenes it accelerates the
  /// bodies.
  RestartReport load(StateReader &reader, double release_time);

private:
  /// Attempts the step, and commits it if it has converged.
  NewtonReport attempt(double t, double previous_step, StepAttempt::Way way = StepAttempt::Way::direct);
  /// Repeats a step that requires it: with raised penalties, and with damped contact.
  void repeat(double t, double previous_step, NewtonReport &report);
  /// Repeats a failed step with lower penalties, and accepts a stalled solution if necessary.
  void recover(double t, double previous_step, NewtonReport &report, DiagnosticList &messages);
  /// Whether continuation from lower penalties may recover a failed step. Collective.
  bool may_continue_penalties(PenaltyContinuation::Start start) const;
  void explain_failure(NewtonReport &report);
  /// Adds the messages after an accepted step.
  void review(NewtonReport &report);
  void commit(double t, NewtonReport &report);

  // Parts of save() and load(), in implicit_solution_state.cc:
  void load_own(StateReader &reader, const OwnedNodes &nodes, bool is_exact);
  /// Computes all forces at the present state: those of supports and tools, and the imbalance.
  void compute_forces(RestartReport &report);

  ImplicitProblem problem_;
  ImplicitParts &parts_ = problem_.parts();
  EquilibriumSolver solver_;
  PenetrationMeasurement measurement_;
  Augmentation augmentation_;
  PenaltyContinuation continuation_;
  StepGuards guards_;
  SpringBooks books_;
  StepDiagnosis diagnosis_;
  std::unique_ptr<StepRules> rules_;
  StepAttempt attempt_;
  ProblemCheckpoint checkpoint_;
  ImplicitReactions reactions_;
  AcceptedSteps accepted_;
  double penetration_ = 0.;
};

} // namespace billet

#endif
