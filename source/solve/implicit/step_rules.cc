// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/step_rules.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/solve/implicit/free_motion.h"
#include "billet/solve/implicit/implicit_motion.h"

#include <algorithm>

namespace billet {

namespace {

/// Returns the names with their kind before them: "tool 'a'".
std::set<std::string> name_all(const std::string &kind, const std::set<std::string> &names) {
  std::set<std::string> all;
  for (const std::string &name : names)
    all.insert(kind + " '" + name + "'");
  return all;
}

/// Springs that begin or end at a time, and the names of those that end, by body.
struct SwitchedSprings {
  bool any = false;
  std::map<std::size_t, std::set<std::string>> ended = {};
};

SwitchedSprings find_switched_springs(const Scene &scene, const double t) {
  SwitchedSprings springs;
  for (std::size_t body = 0; body < scene.bodies().size(); ++body)
    for (const AppliedLoad &load : scene.bodies()[body].loads) {
      if (!load.load.is_spring() || !load.times.changes_at(t))
        continue;
      springs.any = true;
      if (!load.times.acts_after(t))
        springs.ended[body].insert(load.name);
    }
  return springs;
}

} // namespace

std::unique_ptr<StepRules> make_step_rules(ImplicitProblem &problem, const PathGuard &paths,
                                           SpringBooks &books) {
  if (problem.parts().motion() != nullptr)
    return std::make_unique<DynamicRules>(problem, paths, books, *problem.parts().motion());
  return std::make_unique<StaticRules>(problem, paths, books);
}

ToolRemoval::Removal StepRules::remove_tools(const double t) {
  ToolRemoval::Removal removal = parts_.removal().remove_due(t);
  SolutionState &state = problem_.state();
  for (const std::size_t tool : removal.tools) {
    // The energy of its penalty springs is removed with it.
    state.energies.external -= state.tool_loads[tool].stored_energy;
    state.energies.contact -= state.tool_loads[tool].stored_energy;
    predictor().lose_pace();
    problem_.step().start.contact -= parts_.removal().forces(tool); // it is no longer contact
  }
  return removal;
}

std::map<std::size_t, std::set<std::string>> StepRules::switch_supports(const double t,
                                                                        const Vector &inertia) {
  std::map<std::size_t, std::set<std::string>> ended;
  const auto &bodies = parts_.scene().bodies();
  for (std::size_t body = 0; body < bodies.size(); ++body)
    for (const Constraint &constraint : bodies[body].constraints) // planes hold always
      if (parts_.supports().acting()(constraint) && !constraint.times.acts_after(t))
        ended[body].insert(constraint.name.substr(std::string("support ").size()));
  ForceState &start = problem_.step().start;
  Vector reactions = start.supports;
  reactions += inertia;
  start.supports -= parts_.switched_supports().switch_supports(t, reactions, problem_.state().displacements);
  parts_.tangent().follow_supports();
  predictor().lose_pace();
  predictor().drop_probe();
  return ended;
}

void StaticRules::check_start() { check_free_modes(problem_); }

void StaticRules::check_next_step() const {
  if (!free_body_.empty())
    throw SolutionFailure(Diagnostic(diagnostic::solution_failed, free_body_)
                              .time(problem_.state().time)
                              .advice("Add a support or a symmetry plane, or keep a tool. Results until then "
                                      "are in '" +
                                      parts_.parameters().output.folder.value + "'"));
}

std::optional<StepFailure> StaticRules::judge(const double t, DiagnosticList &messages) {
  return find_first_failure([&] { return sliding_.judge(t, messages); }, [&] { return raises_.judge(); },
                            [&] { return balance_.judge_contact(t, messages); },
                            [&] { return modes_.judge(t, messages); });
}

DiagnosticList StaticRules::raise_penalties() {
  DiagnosticList messages = raises_.raise();
  predictor_.drop_probe();
  return messages;
}

void StaticRules::commit(const double t) {
  modes_.commit();
  StepRules::commit(t);
}

void StaticRules::find_free_body(const std::map<std::size_t, std::set<std::string>> &losses,
                                 const std::string &kind, const std::string &what_happens) {
  for (const auto &[body, names] : losses)
    if (free_body_.empty() && !parts_.stabilisation().acts_on(body))
      free_body_ = describe_free_mode(problem_, body, name_all(kind, names), what_happens);
}

void StaticRules::close_step(const double t) {
  balance_.update_max_energy();
  const std::map<std::size_t, std::set<std::string>> let_go = remove_tools(t).let_go;
  const bool is_due = parts_.switched_supports().is_due(t);
  std::map<std::size_t, std::set<std::string>> ended;
  if (is_due)
    ended = switch_supports(t, parts_.discretization().make_owned_vector());
  const SwitchedSprings springs = find_switched_springs(parts_.scene(), t);
  // Supports and springs that begin now hold what others let go.
  find_free_body(let_go, "tool", "removed");
  find_free_body(ended, "support", "switched off");
  find_free_body(springs.ended, "spring", "switched off");
  if (is_due || springs.any)
    modes_.follow_supports(t);
}

std::optional<StepFailure> StaticRules::explain(const double t) {
  const Explanation cause = modes_.explain_sliding();
  const Explanation jump = sliding_.explain(t, cause);
  const Explanation &why = jump.empty() ? cause : jump;
  if (why.empty())
    return {};
  const double t_n = problem_.state().time;
  if (lost_.add(t_n, t - t_n))
    throw SolutionFailure(
        Diagnostic(diagnostic::solution_failed, parts_.parameters().file_name + ": " + why.what)
            .time(t_n)
            .advice(why.advice + ". Results until then are in '" + parts_.parameters().output.folder.value +
                    "'"));
  return StepFailure{StepFailure::Kind::explained, why};
}

void StaticRules::save(StateWriter &writer) const {
  writer.write_text("free body", free_body_);
  writer.write("lost equilibrium", lost_.save());
  modes_.save(writer);
  balance_.save(writer);
  parts_.scheme().save(writer, OwnedNodes(parts_.discretization(), NodeKeys(parts_.discretization())));
}

void StaticRules::load(StateReader &reader, const bool is_exact) {
  balance_.load(reader);
  modes_.load(reader, is_exact);
  parts_.scheme().load(reader, OwnedNodes(parts_.discretization(), NodeKeys(parts_.discretization())));
  if (!is_exact)
    return;
  free_body_ = reader.read_text("free body");
  if (reader.has("lost equilibrium"))
    lost_.load(reader.read("lost equilibrium", 2));
}

void StaticRules::hold_imbalance(const Vector &residual) {
  parts_.scheme().start_loads();
  parts_.released().hold(residual, problem_.state().time);
}

void StaticRules::finish_load(StateReader & /*reader*/, const double release_time, RestartReport &report) {
  if (report.is_exact)
    return;
  modes_.begin();
  ReleasedForces &released = parts_.released();
  const double end = parts_.parameters().time_stepping.end_time;
  released.fade_until(release_time > 0. ? std::min(end, released.begin() + release_time) : end);
}

void DynamicRules::start(const Solution &solution) {
  initial_.start();
  penalties_.control(solution); // records the motion at the start, and raises nothing yet
}

std::optional<StepFailure> DynamicRules::judge(const double t, DiagnosticList &messages) {
  return find_first_failure([&] { return paths_.judge_first_contact(t); },
                            [&] { return balance_.judge_contact(t, messages); });
}

void DynamicRules::close_step(const double t) {
  const ToolRemoval::Removal removal = remove_tools(t);
  bool forces_jump = false;
  for (const std::size_t tool : removal.tools) {
    problem_.state().energies.external -= motion_.tools().remove(tool);
    const double jump = 1. - parts_.removal().fading(t, tool);
    problem_.step().start.supports.add(-jump, parts_.removal().forces(tool));
    forces_jump = forces_jump || jump > 0.;
  }
  const bool supports_change = parts_.switched_supports().is_due(t);
  if (supports_change) {
    Vector inertia = parts_.discretization().make_owned_vector();
    motion_.add_end_inertia(inertia);
    switch_supports(t, inertia);
    problem_.state().energies.external += motion_.follow_supports(t);
  }
  // Nodes that supports catch change the forces of dashpots.
  const bool loads_jump = motion_.follow_loads(t, supports_change, problem_.step().start.supports);
  if (forces_jump || supports_change || loads_jump)
    initial_.accelerate();
  motion_.update_state(problem_.state());
  balance_.update_max_energy();
}

void DynamicRules::save(StateWriter &writer) const {
  balance_.save(writer);
  penalties_.save(writer);
  writer.write("kinetic energy", {problem_.state().energies.kinetic});
  writer.write("damps contact", {motion_.contact().is_on() ? 1. : 0.});
  motion_.save(writer, OwnedNodes(parts_.discretization(), NodeKeys(parts_.discretization())));
}

void DynamicRules::load(StateReader &reader, bool /*is_exact*/) {
  balance_.load(reader);
  if (reader.number("damps contact") != 0.)
    motion_.contact().damp(problem_.step().start); // the next step begins with it
  penalties_.load(reader);
}

void DynamicRules::finish_load(StateReader &reader, double /*release_time*/, RestartReport &report) {
  initial_.load(reader, report);
}

} // namespace billet
