// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/implicit_solution.h"

#include "billet/algebra/gather.h"
#include "billet/errors.h"

#include <algorithm>

namespace billet {

namespace {

/// Limits of repeated steps.
struct ImplicitSolutionLimits {
  /// Maximum number of raises of penalties in a step, each by a factor of at least 2. They exhaust
  /// the factor of 100 by which default penalties may rise.
  static constexpr unsigned int max_raises = 6;
};

} // namespace

ImplicitSolution::ImplicitSolution(const Scene &scene, const Discretization &discretization)
    : problem_(scene, discretization), solver_(problem_), measurement_(problem_),
      augmentation_(problem_, solver_, measurement_), continuation_(problem_, solver_), guards_(problem_),
      books_(problem_), diagnosis_(problem_), rules_(make_step_rules(problem_, guards_.paths, books_)),
      attempt_({problem_, solver_, measurement_, augmentation_, continuation_, guards_, *rules_}),
      checkpoint_(problem_), reactions_(problem_),
      accepted_({problem_, *rules_, books_, diagnosis_, reactions_}) {
  if (scene.parameters().restart.is_wanted()) // load() does the rest
    return;
  ContactSet &contacts = parts_.contacts();
  if (!contacts.of_bodies().empty()) {
    for (auto &contact : contacts)
      contact.with_matrix().update(state().displacements);
    for (auto &contact : contacts.of_bodies())
      contact.allow_overlap();
    rules_->check_start();
    parts_.tangent().build();
  }
  rules_->start(*this);
}

ImplicitSolution::~ImplicitSolution() = default;

std::array<std::size_t, 2> ImplicitSolution::history_sizes() const {
  std::array<std::size_t, 2> sizes = {{parts_.internal().history_size(), parts_.contacts().history_size()}};
  for (auto &size : sizes)
    size = dealii::Utilities::MPI::sum(size, parts_.communicator());
  return sizes;
}

std::vector<ElementPoints> ImplicitSolution::element_points(const std::size_t body) const {
  const ElementBlock &block = parts_.internal().block(body);
  const std::vector<ThicknessAxis> axes = block.thickness_axes();
  const auto &elements = discretization().elements(body);
  std::vector<ElementPoints> result;
  for (std::size_t e = 0; e < elements.size(); ++e)
    result.push_back({block.compute_stress(e, gather(state().displacements, elements[e].dofs)),
                      axes.empty() ? ThicknessAxis() : axes[e]});
  return result;
}

DiagnosticList ImplicitSolution::initial_diagnostics() const {
  DiagnosticList messages = parts_.contacts().check_start();
  append(messages, parts_.stabilisation().check_needless());
  return messages;
}

DiagnosticList ImplicitSolution::finish() const {
  DiagnosticList messages = rules_->check_stabilisation();
  append(messages, rules_->balance().finish());
  append(messages, augmentation_.finish());
  append(messages, guards_.finish());
  return messages;
}

NewtonReport ImplicitSolution::attempt(const double t, const double previous_step,
                                       const StepAttempt::Way way) {
  NewtonReport report = attempt_.make(t, previous_step, way);
  if (report.converged)
    commit(t, report);
  return report;
}

void ImplicitSolution::repeat(const double t, const double previous_step, NewtonReport &report) {
  for (unsigned int n = 0;
       report.rejection == StepFailure::Kind::penetrates && n < ImplicitSolutionLimits::max_raises; ++n) {
    append(report.diagnostics, rules_->raise_penalties());
    report.append_anew(attempt(t, previous_step));
  }
  if (report.rejection == StepFailure::Kind::makes_energy) { // repeat with damped contact
    parts_.scheme().contact().damp(problem_.step().start);
    report.append_anew(attempt(t, previous_step));
  }
}

void ImplicitSolution::recover(const double t, const double previous_step, NewtonReport &report,
                               DiagnosticList &messages) {
  bool may_accept_stalled = report.is_stalled;
  if (!report.converged && (!report.is_explained() || rules_->may_mend_explained()) &&
      augmentation_.soften_contacts(report, books_, messages))
    report.append_anew(attempt(t, previous_step));
  const auto continue_from = [&](const PenaltyContinuation::Start start, const StepAttempt::Way way) {
    if (report.converged || report.is_explained() || report.iterations.empty() ||
        !may_continue_penalties(start))
      return;
    report.append_anew(attempt(t, previous_step, way));
    may_accept_stalled = may_accept_stalled || report.is_stalled;
    if (report.converged && start == PenaltyContinuation::Start::enough)
      messages.push_back(continuation_.describe());
  };
  continue_from(PenaltyContinuation::Start::enough, StepAttempt::Way::by_enough_penalties);
  continue_from(PenaltyContinuation::Start::low, StepAttempt::Way::by_low_penalties);
  if (!report.converged && !report.is_explained() && may_accept_stalled && !solver_.accepts_stalled()) {
    solver_.accept_stalled(true);
    report.append_anew(attempt(t, previous_step));
  }
}

bool ImplicitSolution::may_continue_penalties(const PenaltyContinuation::Start start) const {
  return rules_->may_continue_penalties() && continuation_.is_possible(start);
}

NewtonReport ImplicitSolution::step(const double t, const double previous_step) {
  rules_->check_next_step();
  DiagnosticList messages;
  augmentation_.soften_sheets(books_, messages);
  parts_.scheme().contact().choose(problem_.step().start);
  // Iterations that stall with high penalties may converge by continuation from lower ones.
  solver_.accept_stalled(!may_continue_penalties(PenaltyContinuation::Start::enough));
  NewtonReport report = attempt(t, previous_step);
  repeat(t, previous_step, report);
  recover(t, previous_step, report, messages);
  measurement_.withdraw();
  if (!report.converged) {
    rules_->predictor().drop_probe(); // it may be a poor guess
    explain_failure(report);
  }
  TangentSolver &linear = parts_.tangent().solver();
  report.linear_iterations = linear.take_iterations();
  append(report.diagnostics, std::move(messages));
  append(report.diagnostics, linear.take_diagnostics());
  if (report.converged)
    review(report);
  return report;
}

void ImplicitSolution::explain_failure(NewtonReport &report) {
  report.is_lost_in_round_off =
      report.is_lost_in_round_off || (!report.is_explained() && guards_.round_off.may_explain(report));
  if (report.is_lost_in_round_off) {
    const Explanation why = guards_.round_off.describe(report.force);
    report.failure = why.what;
    report.advice = why.advice;
    return;
  }
  Explanation why{report.failure, report.advice};
  if (!report.is_explained()) {
    why += diagnosis_.describe_contacts();
    why += rules_->describe_sliding();
    why += diagnosis_.describe_residual();
  }
  why += rules_->describe_loss(why.what);
  report.failure = why.what;
  report.advice = why.advice;
}

void ImplicitSolution::review(NewtonReport &report) {
  append(report.diagnostics, parts_.tangent().solver().check_condition());
  append(report.diagnostics, books_.check());
  if (report.is_stalled)
    report.diagnostics.push_back(diagnosis_.describe_stall(report));
  else
    append(report.diagnostics, guards_.round_off.check(report.force, solver_.accuracy()));
  append(report.diagnostics, rules_->balance().check());
  append(report.diagnostics, rules_->after_step(*this));
}

ImplicitSolution::Probe ImplicitSolution::probe(const double t, const double previous_step) {
  Probe probe;
  if (!rules_->has_next_step()) // the step itself reports it
    return probe;
  parts_.scheme().contact().choose(problem_.step().start);
  solver_.set_probing(true);
  rules_->predictor().drop_probe();
  const SoftnessLimit learnt = augmentation_.softness();
  probe.newton = attempt_.make(t, previous_step);
  augmentation_.set_softness(learnt);
  solver_.set_probing(false);
  if (probe.newton.converged) {
    probe.results = StepResults(problem_).of_trial();
    rules_->predictor().keep_probe(t);
  }
  probe.newton.linear_iterations = parts_.tangent().solver().take_iterations();
  append(probe.newton.diagnostics, parts_.tangent().solver().take_diagnostics());
  return probe;
}

void ImplicitSolution::commit(const double t, NewtonReport &report) {
  const double t_n = problem_.state().time, drift_n = problem_.state().energies.drift();
  // These use the trial state and the last residual:
  reactions_.start();
  append(report.diagnostics, guards_.commit(t, report));
  penetration_ = parts_.contacts().find_penetration();
  augmentation_.commit();
  continuation_.forbid_low();
  rules_->predictor().commit();
  ForceScales &scales = problem_.scales();
  scales.lasting = std::max(scales.lasting, ForceScales::Limits::lasting * scales.force);

  accepted_.commit(t);
  const InternalForces::Energies &energies = rules_->balance().trial_energies();
  EnergyLedger &ledger = problem_.state().energies;
  ledger.elastic = energies.elastic;
  ledger.plastic = energies.plastic;
  ledger.hourglass = energies.hourglass;
  // Work that a finer mesh loses until it is in balance is not work of the model.
  if (parts_.released().are_of_refinement() && parts_.released().left(t_n) > 0.)
    ledger.initial += drift_n - ledger.drift();

  // The rest changes between steps:
  rules_->close_step(t);
  if (!attempt_.stopping().empty())
    rules_->predictor().lose_pace();
  for (const std::size_t tool : attempt_.stopping())
    parts_.tools().stop(tool, problem_.state().placements[tool]);
}

} // namespace billet
