// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/implicit_solution.h"

#include "billet/errors.h"

#include <algorithm>

namespace billet {

namespace {

/// Limits of repeated steps.
struct Limits {
  /// Maximum number of raises of penalties in a step, each by a factor of at least 2: they exhaust the factor
  /// of 100 by which default penalties may rise.
  static constexpr unsigned int max_raises = 6;
};

} // namespace

ImplicitSolution::ImplicitSolution(const Scene &scene, const Discretization &discretization)
    : problem_(scene, discretization), solver_(problem_), measurement_(problem_),
      augmentation_(problem_, solver_, measurement_), continuation_(problem_, solver_), paths_(problem_),
      round_off_(problem_), books_(problem_), diagnosis_(problem_),
      rules_(make_step_rules(problem_, paths_, books_)),
      attempt_({problem_, solver_, measurement_, augmentation_, continuation_, paths_, round_off_, *rules_}),
      checkpoint_(problem_), reactions_(problem_) {
  if (scene.parameters().restart.is_wanted()) // load() does the rest
    return;
  ContactSet &contacts = problem_.contacts();
  if (!contacts.of_bodies().empty()) {
    for (auto &contact : contacts)
      contact.update(state().displacements);
    for (auto &contact : contacts.of_bodies())
      contact.allow_overlap();
    rules_->check_start();
    problem_.tangent().build();
  }
  rules_->start(*this);
}

ImplicitSolution::~ImplicitSolution() = default;

std::array<std::size_t, 2> ImplicitSolution::history_sizes() const {
  std::array<std::size_t, 2> sizes = {
      {problem_.internal().history_size(), problem_.contacts().history_size()}};
  for (auto &size : sizes)
    size = dealii::Utilities::MPI::sum(size, problem_.communicator());
  return sizes;
}

DiagnosticList ImplicitSolution::initial_diagnostics() const {
  DiagnosticList messages = problem_.contacts().check_start();
  append(messages, problem_.stabilisation().check_needless());
  return messages;
}

DiagnosticList ImplicitSolution::finish() const {
  DiagnosticList messages = rules_->check_stabilisation();
  append(messages, rules_->balance().finish());
  append(messages, round_off_.finish());
  append(messages, augmentation_.finish());
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
  for (unsigned int n = 0; report.penetrates && n < Limits::max_raises; ++n) {
    append(report.diagnostics, rules_->raise_penalties());
    report.append_anew(attempt(t, previous_step));
  }
  if (report.makes_energy) { // repeat with damped contact
    problem_.scheme().damp_contact(problem_.step().start);
    report.append_anew(attempt(t, previous_step));
  }
}

void ImplicitSolution::recover(const double t, const double previous_step, NewtonReport &report,
                               DiagnosticList &messages) {
  bool may_accept_stalled = report.is_stalled;
  if (!report.converged && (!report.is_explained || rules_->may_mend_explained()) &&
      augmentation_.soften_contacts(messages))
    report.append_anew(attempt(t, previous_step));
  const auto continue_from = [&](const PenaltyContinuation::Start start, const StepAttempt::Way way) {
    if (report.converged || report.is_explained || report.iterations.empty() ||
        !may_continue_penalties(start))
      return;
    report.append_anew(attempt(t, previous_step, way));
    may_accept_stalled = may_accept_stalled || report.is_stalled;
    if (report.converged && start == PenaltyContinuation::Start::enough)
      messages.push_back(continuation_.describe());
  };
  continue_from(PenaltyContinuation::Start::enough, StepAttempt::Way::by_enough_penalties);
  continue_from(PenaltyContinuation::Start::low, StepAttempt::Way::by_low_penalties);
  if (!report.converged && !report.is_explained && may_accept_stalled && !solver_.accepts_stalled()) {
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
  problem_.scheme().choose_contact_damping(problem_.step().start);
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
  TangentSolver &linear = problem_.tangent().solver();
  report.linear_iterations = linear.take_iterations();
  append(report.diagnostics, std::move(messages));
  append(report.diagnostics, linear.take_diagnostics());
  if (report.converged)
    review(report);
  return report;
}

void ImplicitSolution::explain_failure(NewtonReport &report) {
  report.is_lost_in_round_off =
      report.is_lost_in_round_off || (!report.is_explained && round_off_.may_explain(report));
  if (report.is_lost_in_round_off) {
    const Explanation why = round_off_.describe(report.force);
    report.failure = why.what;
    report.advice = why.advice;
    return;
  }
  Explanation why{report.failure, report.advice};
  if (!report.is_explained) {
    why += diagnosis_.describe_contacts();
    why += rules_->describe_sliding();
    why += diagnosis_.describe_residual();
  }
  why += rules_->describe_loss(why.what);
  report.failure = why.what;
  report.advice = why.advice;
}

void ImplicitSolution::review(NewtonReport &report) {
  append(report.diagnostics, problem_.tangent().solver().check_condition());
  append(report.diagnostics, books_.check());
  if (report.is_stalled)
    report.diagnostics.push_back(diagnosis_.describe_stall(report));
  else
    append(report.diagnostics, round_off_.check(report.force, solver_.accuracy()));
  append(report.diagnostics, rules_->balance().check());
  append(report.diagnostics, rules_->after_step(*this));
}

ImplicitSolution::Probe ImplicitSolution::probe(const double t, const double previous_step) {
  Probe probe;
  if (!rules_->has_next_step()) // the step itself reports it
    return probe;
  problem_.scheme().choose_contact_damping(problem_.step().start);
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
  probe.newton.linear_iterations = problem_.tangent().solver().take_iterations();
  append(probe.newton.diagnostics, problem_.tangent().solver().take_diagnostics());
  return probe;
}

void ImplicitSolution::commit(const double t, NewtonReport &report) {
  const double t_n = problem_.state().time, drift_n = problem_.state().energies.drift();
  StepState &step = problem_.step();
  ForceScales &scales = problem_.scales();
  reactions_.start();
  round_off_.commit(t, report);
  penetration_ = problem_.contacts().find_penetration();
  append(report.diagnostics, paths_.check_motion(t));
  augmentation_.commit();
  continuation_.forbid_low();
  rules_->predictor().commit();
  scales.lasting = std::max(scales.lasting, ForceScales::Limits::lasting * scales.force);
  step.last_increment = step.trial.displacements;
  step.last_increment -= step.start.displacements;
  problem_.tools().commit();
  commit_works(t);
  commit_loads(t);
  problem_.state().time = t;
  problem_.state().displacements = step.start.displacements;
  const InternalForces::Energies &energies = rules_->balance().trial_energies();
  EnergyLedger &ledger = problem_.state().energies;
  ledger.elastic = energies.elastic;
  ledger.plastic = energies.plastic;
  ledger.hourglass = energies.hourglass;
  // What a finer mesh loses until it is in balance is not work of the model.
  if (releases_refinement_ && problem_.released().left(t_n) > 0.)
    ledger.initial += drift_n - ledger.drift();
  rules_->close_step(t);
  if (!attempt_.stopping().empty())
    rules_->predictor().lose_pace();
  for (const std::size_t tool : attempt_.stopping())
    problem_.tools().stop(tool, problem_.state().placements[tool]);
}

void ImplicitSolution::commit_works(const double t) {
  StepState &step = problem_.step();
  SolutionState &state = problem_.state();
  // Work of the supports and of the tools, by the trapezoidal rule, but with (I4) that of contact by its
  // forces at the end.
  const double before = problem_.scheme().contact_before();
  const StepWorks works = problem_.contacts().compute_step_works(1. - before);
  state.energies.external -= problem_.removal().work(state.time, t, step.last_increment);
  if (!releases_refinement_)
    state.energies.external += problem_.released().work(state.time, t, step.last_increment);
  state.energies.external += problem_.switched_supports().work(state.time, t, step.last_increment);
  rules_->commit(t);
  step.start.displacements = step.trial.displacements;
  problem_.internal().commit();
  Vector mean_forces = step.trial.supports;
  mean_forces += step.start.supports;
  mean_forces *= 0.5;
  mean_forces.add(0.5 - before, step.trial.contact, before - 0.5, step.start.contact);
  reactions_.set_loads(problem_.scheme().commit(step.start.displacements, step.last_increment, mean_forces,
                                                works.touching, state.energies));
  state.energies.external += works.ramp;
  step.start.internal = step.trial.internal;
  step.start.supports = step.trial.supports;
  step.start.contact = step.trial.contact;
}

void ImplicitSolution::commit_loads(const double t) {
  SolutionState &state = problem_.state();
  ContactSet &contacts = problem_.contacts();
  const double before = problem_.scheme().contact_before();
  const std::vector<ContactLoad> loads_n = state.tool_loads;
  const std::vector<Placement> placements_n = state.placements;
  diagnosis_.commit();
  std::fill(state.tool_loads.begin(), state.tool_loads.end(), ContactLoad());
  state.energies.contact = 0.;
  auto body_pair_load = state.body_pair_loads.begin();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactLoad load = contacts[i].measures().compute_load();
    if (const auto &tool = contacts[i].rigid_tool()) {
      state.tool_loads[*tool] += load;
      books_.set(i, load.stored_energy);
      reactions_.set_pair(contacts[i].group_index(), load, contacts[i].measures().penetration_between_nodes(),
                          problem_.tools().place(*tool, t, problem_.tools().offsets()[*tool]));
    } else {
      *body_pair_load++ = load;
      state.energies.contact += load.stored_energy;
      state.energies.friction += load.dissipation;
    }
    contacts[i].commit();
  }
  const auto &tools = problem_.scene().tools();
  for (std::size_t i = 0; i < tools.size(); ++i) {
    const ContactLoad &load = state.tool_loads[i];
    Placement &placement = state.placements[i];
    placement = problem_.tools().place(i, t, problem_.tools().offsets()[i]);
    if (problem_.removal().is_removed(i)) // it does no work
      continue;
    const double turn = placement.rotation_angle - placements_n[i].rotation_angle;
    state.energies.external +=
        ((1. - before) * load.force + before * loads_n[i].force) *
            (placement.translation - placements_n[i].translation) +
        ((1. - before) * load.moment + before * loads_n[i].moment) * tools[i].rotation_axis() * turn;
    state.energies.contact += load.stored_energy;
    state.energies.friction += load.dissipation;
    if (problem_.scheme().has_mass(i))
      problem_.scheme().commit_tool(i, problem_.tools().offsets()[i], problem_.tools().exerted_load(i),
                                    tools[i].load(t), state.energies);
  }
}

} // namespace billet
