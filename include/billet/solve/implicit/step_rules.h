// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_STEP_RULES_H
#define BILLET_SOLVE_IMPLICIT_STEP_RULES_H

#include "billet/solve/implicit/energy_balance.h"
#include "billet/solve/implicit/initial_motion.h"
#include "billet/solve/implicit/penalty_raises.h"
#include "billet/solve/implicit/predictor.h"
#include "billet/solve/implicit/rigid_body_modes.h"
#include "billet/solve/implicit/sliding_guard.h"
#include "billet/solve/rejected_steps.h"

#include <map>
#include <memory>
#include <set>
#include <string>

namespace billet {

/// Rules of a scheme for steps, beside its equation: how they begin, which are rejected, and what
/// follows them. There is one class each for static and dynamic scenes.
class StepRules {
public:
  StepRules(ImplicitProblem &problem, const PathGuard &paths, SpringBooks &books)
      : problem_(problem), paths_(paths), books_(books) {}
  virtual ~StepRules() = default;
  StepRules(const StepRules &) = delete;
  StepRules &operator=(const StepRules &) = delete;

  virtual Predictor &predictor() = 0;
  virtual const Predictor &predictor() const = 0;
  virtual EnergyBalance &balance() = 0;

  /// Check the contacts at time 0, with InputError, and start the run there. Collective.
  virtual void check_start() {}
  virtual void start(const Solution &) {}
  /// Throws SolutionFailure, on all ranks, if no step can follow the last one.
  virtual void check_next_step() const {}
  virtual bool has_next_step() const { return true; }

  /// Begins an attempt of a step.
  virtual void begin_attempt() {}
  /// Returns why a converged step fails, if it does. Collective.
  virtual std::optional<StepFailure> judge(double t, DiagnosticList &messages) = 0;
  /// Explains a step for whose failure the iterations give no reason, if the bodies do. Throws
  /// SolutionFailure, on all ranks, if shorter steps will not help. Collective.
  virtual std::optional<StepFailure> explain(double /*t*/) { return {}; }
  /// Whether lower penalties may help a step that failed for a known reason. In dynamics, converged
  /// steps that are too long need shorter ones.
  virtual bool may_mend_explained() const = 0;
  /// Whether a failed step may be approached by continuation from lower penalties. In dynamics,
  /// inertia and shorter steps have the same effect.
  virtual bool may_continue_penalties() const = 0;
  /// Raises penalties if a step requires it. Collective.
  virtual DiagnosticList raise_penalties() { return {}; }
  /// Return clauses on the state before a step that failed for this reason, if it may explain the
  /// failure.
  virtual Explanation describe_sliding() const { return {}; }
  virtual Explanation describe_loss(const std::string & /*failure*/) const { return {}; }

  /// Accepts the step before the start of the next one changes, ...
  virtual void commit(double t) { balance().commit(t); }
  /// ... and closes it after all works are recorded: removes tools at t. Collective.
  virtual void close_step(double t) = 0;
  /// Returns messages after close_step(). Collective.
  virtual DiagnosticList after_step(const Solution &) { return {}; }

  /// Returns messages about stabilised bodies at the end of the run. Collective.
  virtual DiagnosticList check_stabilisation() const { return {}; }

  virtual void save(StateWriter &writer) const = 0;
  /// Loads the state of the same scheme.
  virtual void load(StateReader &reader, bool is_exact) = 0;
  /// Takes over forces that are out of balance after a restart, as this residual.
  virtual void hold_imbalance(const Vector & /*residual*/) {}
  /// Completes a restart after everything else is loaded. `release_time`: see
  /// ImplicitSolution::load(). Collective.
  virtual void finish_load(StateReader &reader, double release_time, RestartReport &report) = 0;

protected:
  /// Removes tools that are due at t. Collective.
  ToolRemoval::Removal remove_tools(double t);
  /// Switches the supports that are due at t. Returns the names of those that each body loses.
  /// `inertia`: its forces. Collective.
  std::map<std::size_t, std::set<std::string>> switch_supports(double t, const Vector &inertia);

  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
  const PathGuard &paths_;
  SpringBooks &books_;
};

/// Makes the rules of the problem's scheme.
std::unique_ptr<StepRules> make_step_rules(ImplicitProblem &problem, const PathGuard &paths,
                                           SpringBooks &books);

class StaticRules final : public StepRules {
public:
  StaticRules(ImplicitProblem &problem, const PathGuard &paths, SpringBooks &books)
      : StepRules(problem, paths, books), predictor_(problem), balance_(problem), sliding_(problem),
        modes_(problem), raises_(problem, books) {}

  Predictor &predictor() override { return predictor_; }
  const Predictor &predictor() const override { return predictor_; }
  EnergyBalance &balance() override { return balance_; }
  void check_start() override;
  void check_next_step() const override;
  bool has_next_step() const override { return free_body_.empty(); }
  void begin_attempt() override { sliding_.begin(); }
  std::optional<StepFailure> judge(double t, DiagnosticList &messages) override;
  std::optional<StepFailure> explain(double t) override;
  bool may_mend_explained() const override { return true; }
  bool may_continue_penalties() const override { return true; }
  DiagnosticList raise_penalties() override;
  Explanation describe_sliding() const override {
    Explanation why = modes_.describe_sliding();
    return why.empty() ? why : Explanation{"; " + why.what, why.advice};
  }
  Explanation describe_loss(const std::string &failure) const override {
    return modes_.describe_loss(failure);
  }
  void commit(double t) override;
  void close_step(double t) override;
  DiagnosticList check_stabilisation() const override { return modes_.finish(balance_.max_energy()); }
  void save(StateWriter &writer) const override;
  void load(StateReader &reader, bool is_exact) override;
  void hold_imbalance(const Vector &residual) override;
  void finish_load(StateReader &reader, double release_time, RestartReport &report) override;

private:
  /// Sets free_body_ for the first body that what it loses, by body, leaves free; with the kind of
  /// these and what happens to them. Collective.
  void find_free_body(const std::map<std::size_t, std::set<std::string>> &losses, const std::string &kind,
                      const std::string &what_happens);

  Predictor predictor_;
  StaticBalance balance_;
  SlidingGuard sliding_;
  RejectedSteps lost_; ///< that failed for want of an equilibrium
  RigidBodyModes modes_;
  PenaltyRaises raises_;
  std::string free_body_; ///< why no step can follow: removed tools or supports held this body
};

class DynamicRules final : public StepRules {
public:
  DynamicRules(ImplicitProblem &problem, const PathGuard &paths, SpringBooks &books, ImplicitMotion &motion)
      : StepRules(problem, paths, books), motion_(motion), predictor_(problem, motion),
        balance_(problem, paths, motion), initial_(problem, motion), penalties_(problem, books) {}

  Predictor &predictor() override { return predictor_; }
  const Predictor &predictor() const override { return predictor_; }
  EnergyBalance &balance() override { return balance_; }
  void start(const Solution &solution) override;
  std::optional<StepFailure> judge(double t, DiagnosticList &messages) override;
  bool may_mend_explained() const override { return false; }
  bool may_continue_penalties() const override { return false; }
  void close_step(double t) override;
  DiagnosticList after_step(const Solution &solution) override { return penalties_.control(solution); }
  void save(StateWriter &writer) const override;
  void load(StateReader &reader, bool is_exact) override;
  void finish_load(StateReader &reader, double release_time, RestartReport &report) override;

private:
  ImplicitMotion &motion_;
  MotionPredictor predictor_;
  DynamicBalance balance_;
  InitialMotion initial_;
  DynamicPenalties penalties_;
};

} // namespace billet

#endif
