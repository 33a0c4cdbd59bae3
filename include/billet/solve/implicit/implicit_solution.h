// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_IMPLICIT_SOLUTION_H
#define BILLET_SOLVE_IMPLICIT_IMPLICIT_SOLUTION_H

#include "billet/solve/implicit/problem_checkpoint.h"
#include "billet/solve/implicit/step_attempt.h"
#include "billet/solve/implicit/step_diagnosis.h"
#include "billet/solve/solution.h"

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace billet {

/// Solution of a static scene, or one of implicit dynamics, step by step: attempts a step, recovers where
/// that fails, and commits it on acceptance. There is nothing to undo on failure, since the state at the
/// start of a step is never written to.
class ImplicitSolution final : public Solution {
public:
  ImplicitSolution(const Scene &scene, const Discretization &discretization);

  /// Tries the step from the current time to `t`. On convergence the new state is committed. `previous_step`
  /// is the length of the last accepted step if its increment may be continued, 0 else. Throws
  /// SolutionFailure, on all ranks, where the removal of tools has left a body free.
  NewtonReport step(double t, double previous_step);

  using Results = StepResults::Groups;
  /// At the last accepted step. Their number is that of result_names().
  Results results() const { return StepResults(problem_).accepted(); }
  std::vector<std::string> result_names() const { return StepResults(problem_).names(); }

  /// A step that is tried and not taken.
  struct Probe {
    NewtonReport newton;
    Results results; ///< at its end
  };
  /// Tries the step to `t`, and leaves the state as it is. The next steps up to `t` begin their iterations
  /// from what it found.
  Probe probe(double t, double previous_step);

  /// The next step measures what penetrations make of the results, if it is accepted; see
  /// PenetrationMeasurement::ask().
  void measure_penetration(const double allowed = std::numeric_limits<double>::infinity()) {
    measurement_.ask(allowed);
  }
  /// Of the last accepted step; once.
  std::optional<OfPenetration> take_measurement() { return measurement_.take(); }
  /// Of the last accepted step: the deepest, as part of the 'Penetration tolerance', or of 1e-5 facets in
  /// pairs without one.
  double penetration() const { return penetration_; }
  /// Tractions are augmented where penetrations are above so many times what pairs ask for. What augmentation
  /// leaves above that is an error to be reported, and fails no step.
  void set_penetration_allowed(const double factor) {
    augmentation_.allow_penetration(factor);
    augmentation_.may_leave_penetration();
  }
  /// Residuals, and their work, have to be this part of what the solver's tolerances allow; in (0, 1].
  void set_accuracy(const double factor) { solver_.set_accuracy(factor); }
  /// Where steps with another contact tangent fail; see TangentMatrix::take_exact(). Collective.
  bool take_exact_tangent() { return problem_.tangent().take_exact(); }

  /// Of the last step that was tried, in dynamic scenes: see ImplicitMotion::step_error().
  double time_error() const { return rules_->balance().time_error(); }
  /// Of all bodies, in dynamic scenes.
  double mass() const { return problem_.scheme().mass(); }

  const SolutionState &state() const override { return problem_.state(); }
  const Discretization &discretization() const override { return problem_.discretization(); }
  std::vector<ElementSummary> summarize(const std::size_t body) const override {
    return problem_.internal().summarize(body, state().displacements);
  }
  std::vector<LayerSummaries> summarize_layers(const std::size_t body) const override {
    return problem_.internal().summarize_layers(body, state().displacements);
  }
  std::vector<std::vector<ContactNodeReport>> report_contacts() const override {
    return problem_.contacts().report();
  }
  std::array<std::size_t, 2> history_sizes() const override;
  std::string method() const override { return problem_.tangent().solver().name(); }
  DiagnosticList initial_diagnostics() const override;
  bool solves_iteratively() const override { return problem_.tangent().solver().is_iterative(); }

  /// Messages at the end of the run: about bodies that were stabilised, contact that has lost or made energy
  /// all in all, round-off of penalties, and augmentation that was given up. Collective.
  DiagnosticList finish() const;

  /// The equation that steps solve.
  ImplicitProblem &equation() { return problem_; }
  const ImplicitProblem &equation() const { return problem_; }
  /// See PenaltyWatch::has_soft_pairs().
  bool has_soft_penalties() const { return books_.has_soft_pairs(); }
  /// Whether contact between bodies makes most of what the energies of a dynamic scene fail to balance by.
  bool contact_makes_energy() const { return rules_->balance().contact_makes_energy(); }

  /// The state at the end of the last accepted step.
  void save(StateWriter &writer) const;
  /// Resumes from such a state, in place of the start at time 0, or from that of another method: its
  /// displacements and stresses, and, in dynamic scenes, its velocities. Where a static scene has other tools
  /// or pairs, or the state comes from elsewhere, what is out of balance fades over `release_time`, or, if
  /// that is 0, until the end time. In dynamic ones it accelerates the bodies.
  RestartReport load(StateReader &reader, double release_time);

private:
  /// Attempts the step, and commits it if it has converged.
  NewtonReport attempt(double t, double previous_step, StepAttempt::Way way = StepAttempt::Way::direct);
  /// Repeats a step that asks for it: with penalties that are raised, and with contact damped.
  void repeat(double t, double previous_step, NewtonReport &report);
  /// Attempts a step that has failed once more, with softer penalties, and as near to balance as it comes.
  void recover(double t, double previous_step, NewtonReport &report, DiagnosticList &messages);
  void explain_failure(NewtonReport &report);
  /// Adds the messages after an accepted step.
  void review(NewtonReport &report);
  void commit(double t, NewtonReport &report);
  void commit_works(double t);
  void commit_loads(double t);

  // Of save() and load(), in implicit_solution_state.cc:
  void load_own(StateReader &reader, const OwnedNodes &nodes, bool is_exact);
  /// All forces at the state as it is: those of supports and tools, and what is out of balance.
  void balance(RestartReport &report);

  ImplicitProblem problem_;
  EquilibriumSolver solver_;
  PenetrationMeasurement measurement_;
  Augmentation augmentation_;
  PenaltyContinuation continuation_;
  PathGuard paths_;
  RoundOffGuard round_off_;
  SpringBooks books_;
  StepDiagnosis diagnosis_;
  std::unique_ptr<StepRules> rules_;
  StepAttempt attempt_;
  ProblemCheckpoint checkpoint_;
  double penetration_ = 0.;
};

} // namespace billet

#endif
