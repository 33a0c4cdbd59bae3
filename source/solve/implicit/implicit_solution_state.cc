// SPDX-License-Identifier: LGPL-2.1-or-later
// Checkpoints of implicit solutions, and restarts from them.
#include "billet/errors.h"
#include "billet/solve/implicit/implicit_solution.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace billet {

namespace {

/// Completes a report about the forces of a finer mesh.
void begin_on_finer_mesh(ImplicitProblem &problem, RestartReport &report) {
  // They are those after yielding, at displacements that may be far from balance, and so are the
  // energies.
  EnergyLedger &energies = problem.state().energies;
  const double drift = energies.drift();
  const auto now =
      problem.parts().internal().compute_energies(problem.state().displacements, Beat::evaluated);
  energies.elastic = now.elastic;
  energies.plastic = now.plastic;
  energies.hourglass = now.hourglass;
  const double change = drift - energies.drift();
  report.energy_change += change;
  energies.initial += change;
  // A mesh in balance has nothing that fades, so that no step has to end with it.
  if (report.imbalance <= problem.parts().parameters().solver.force_tolerance * report.force_scale)
    problem.parts().released().clear();
  else
    problem.parts().released().are_of_refinement(true);
}

} // namespace

void ImplicitSolution::save(StateWriter &writer) const {
  const Discretization &discretization = parts_.discretization();
  const NodeKeys keys(discretization);
  const OwnedNodes nodes(discretization, keys);
  const StepState &step = problem_.step();
  writer.write_text("scheme", parameters::name_of(parts_.scheme().kind()));
  writer.write("time", {state().time});
  writer.write("energies", to_numbers(state().energies));
  save_nodal(writer, "displacements", nodes, step.start.displacements);
  save_nodal(writer, "increment", nodes, step.last_increment);
  save_nodal(writer, "support forces", nodes, step.start.supports);
  save_nodal(writer, "internal forces", nodes, step.start.internal);
  save_nodal(writer, "contact forces", nodes, step.start.contact);
  const StepRules &rules = *rules_;
  writer.write("scales", {problem_.scales().lasting, rules.predictor().has_lost_pace() ? 1. : 0.});
  books_.save(writer);
  augmentation_.save(writer);
  guards_.save(writer);
  if (!parts_.tangent().is_kind_of_scene())
    writer.write("exact tangent", {1.});
  rules.predictor().save(writer, nodes);
  rules.save(writer);
  checkpoint_.save_bodies(writer);
  checkpoint_.save_tools(writer, nodes);
  checkpoint_.save_contacts(writer, keys);
  parts_.released().save(writer, nodes);
  parts_.switched_supports().save(writer, nodes);
}

RestartReport ImplicitSolution::load(StateReader &reader, const double release_time) {
  const NodeKeys keys(parts_.discretization());
  const OwnedNodes nodes(parts_.discretization(), keys);
  StepState &step = problem_.step();
  SolutionState &state = problem_.state();
  RestartReport report;
  using Scheme = parameters::TimeStepping::Scheme;
  const std::string name_of_scheme = reader.read_text("scheme");
  const std::optional<Scheme> scheme = parameters::find_value(parameters::schemes(), name_of_scheme);
  if (!scheme)
    throw InputError("its scheme '" + name_of_scheme + "' is unknown; known are " +
                     parameters::selection(parameters::schemes()));
  const bool is_implicit = parameters::type_of(*scheme).has_matrix, is_own = scheme == parts_.scheme().kind();
  report.is_exact = is_own && refined_bodies(reader).empty();
  compare_parts(reader, parts_.scene(), report);
  state.energies = to_energies(reader.read("energies"));
  load_nodal(reader, is_implicit ? "displacements" : "displacements before", nodes, step.start.displacements);
  state.displacements = step.start.displacements;
  step.trial.displacements = step.start.displacements;
  step.ghosted = step.start.displacements;
  state.time = step.time = report.time = reader.number(is_implicit ? "time" : "time before");
  parts_.switched_supports().load(reader, nodes, state.time, state.displacements);
  if (parts_.supports().acting().may_change())
    parts_.tangent().follow_supports();
  if (!parts_.scheme().has_inertia() && reader.has("kinetic energy"))
    report.kinetic_energy = reader.number("kinetic energy");
  checkpoint_.load_bodies(reader, report);
  checkpoint_.load_tools(reader, nodes);
  checkpoint_.load_contacts(reader, keys);
  checkpoint_.update_contacts(reader, report.is_exact);
  problem_.scales().spring_round_off =
      parts_.contacts().find_spring_round_off(); // with the present penalties
  if (is_own)
    load_own(reader, nodes, report.is_exact);
  if (!report.is_exact) {
    compute_forces(report);
    if (!refined_bodies(reader).empty())
      begin_on_finer_mesh(problem_, report);
  }
  rules_->finish_load(reader, release_time, report);
  report.release_end = parts_.released().are_there() ? parts_.released().end() : state.time;
  return report;
}

void ImplicitSolution::load_own(StateReader &reader, const OwnedNodes &nodes, const bool is_exact) {
  StepState &step = problem_.step();
  load_nodal(reader, "increment", nodes, step.last_increment);
  load_nodal(reader, "support forces", nodes, step.start.supports);
  load_nodal(reader, "contact forces", nodes, step.start.contact);
  load_nodal(reader, "internal forces", nodes, step.start.internal);
  guards_.load(reader);
  books_.load(reader);
  rules_->load(reader, is_exact);
  if (is_exact)
    augmentation_.load(reader);
  rules_->predictor().load(reader, nodes, is_exact);
  if (reader.has("exact tangent"))
    parts_.tangent().take_exact();
  problem_.scales().lasting = reader.read("scales", 2).at(0);
  parts_.released().load(reader, nodes, parts_.discretization());
}

void ImplicitSolution::compute_forces(RestartReport &report) {
  problem_.start_at_rest();
  parts_.released().clear();
  parts_.tools().choose_unknown({});
  StepState &step = problem_.step();
  SolutionState &state = problem_.state();
  Vector residual = parts_.discretization().make_owned_vector();
  if (!problem_.compute_residual(step.start.displacements, residual))
    throw InputError("its state is not admissible here: elements are inverted, or forces are not finite");
  report.imbalance = residual.l2_norm();
  report.force_scale = problem_.force_scale();
  problem_.scales().lasting =
      std::max(problem_.scales().lasting, ForceScales::Limits::lasting * problem_.force_scale());
  const Contacts::Loads loads = problem_.start_from_trial();
  // Energy that the interruption changes is not drift.
  EnergyLedger &energies = state.energies;
  const double drift = energies.drift();
  energies.contact = 0.;
  for (const auto *of : {&loads.of_tools, &loads.of_body_pairs})
    for (const ContactLoad &load : *of)
      energies.contact += load.stored_energy;
  const auto now = parts_.internal().compute_energies(state.displacements);
  if (!parts_.scheme().has_inertia())
    energies.kinetic = 0.;
  energies.hourglass = now.hourglass;
  energies.elastic = now.elastic;
  energies.plastic = now.plastic;
  report.energy_change = drift - energies.drift();
  energies.initial += report.energy_change;
  rules_->hold_imbalance(residual);
}

} // namespace billet
