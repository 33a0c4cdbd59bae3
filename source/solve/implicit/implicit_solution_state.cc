// SPDX-License-Identifier: LGPL-2.1-or-later
// What an implicit solution gives to a checkpoint, and how it resumes from one.
#include "billet/errors.h"
#include "billet/solve/implicit/implicit_solution.h"

#include <algorithm>
#include <cmath>

namespace billet {

void ImplicitSolution::save(StateWriter &writer) const {
  const Discretization &discretization = problem_.discretization();
  const Scene &scene = problem_.scene();
  const NodeKeys keys(discretization);
  const OwnedNodes nodes(discretization, keys);
  const StepState &step = problem_.step();
  writer.write_text("scheme", problem_.scheme().name());
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
  round_off_.save(writer);
  if (!problem_.tangent().is_kind_of_scene())
    writer.write("exact tangent", {1.});
  rules.predictor().save(writer, nodes);
  rules.save(writer);
  for (std::size_t b = 0; b < scene.bodies().size(); ++b)
    writer.in(group("body", b), [&] { save_body(b, writer); });
  for (std::size_t i = 0; i < scene.tools().size(); ++i)
    writer.in(group("tool", i), [&] {
      problem_.tools().save(i, state().placements[i], writer);
      writer.write("flags",
                   {problem_.tools().is_stopped(i) ? 1. : 0., problem_.removal().is_removed(i) ? 1. : 0.});
      writer.write("load", to_numbers(state().tool_loads[i]));
      problem_.scheme().save_tool(i, writer);
      problem_.removal().save(i, writer, nodes);
    });
  save_contacts(writer, keys);
  problem_.released().save(writer, nodes);
}

void ImplicitSolution::save_body(const std::size_t body, StateWriter &writer) const {
  const ElementFormulation &formulation = problem_.scene().bodies()[body].formulation;
  writer.write_text("formulation", describe(formulation, *problem_.scene().bodies()[body].law));
  const ElementBlock &block = problem_.internal().block(body);
  const std::vector<std::uint64_t> keys = element_keys(problem_.discretization(), body);
  if (formulation.points_through > 2)
    save_thickness_axes(writer, block, keys);
  const std::size_t width = block.state_size();
  if (width == 0)
    return;
  std::vector<double> rows(width * block.size());
  for (std::size_t e = 0; e < block.size(); ++e)
    block.get_state(e, rows.data() + width * e);
  writer.write_rows("history", width, keys, rows);
}

void ImplicitSolution::save_contacts(StateWriter &writer, const NodeKeys &keys) const {
  auto body_pair_load = state().body_pair_loads.begin();
  for (const auto &contact : problem_.contacts())
    writer.in(group(contact.group_kind(), contact.group_index()), [&] {
      save_pair(writer, contact);
      if (!contact.rigid_tool())
        writer.write("load", to_numbers(*body_pair_load++));
      contact.save(writer, keys);
      contact.save_couplings(writer);
    });
}

RestartReport ImplicitSolution::load(StateReader &reader, const double release_time) {
  const NodeKeys keys(problem_.discretization());
  const OwnedNodes nodes(problem_.discretization(), keys);
  StepState &step = problem_.step();
  SolutionState &state = problem_.state();
  RestartReport report;
  const std::string scheme = reader.read_text("scheme");
  const bool is_implicit = scheme != "explicit", is_own = scheme == problem_.scheme().name();
  report.is_exact = is_own;
  compare_parts(reader, problem_.scene(), report);
  state.energies = to_energies(reader.read("energies"));
  load_nodal(reader, is_implicit ? "displacements" : "displacements before", nodes, step.start.displacements);
  state.displacements = step.start.displacements;
  step.trial.displacements = step.start.displacements;
  step.ghosted = step.start.displacements;
  state.time = step.time = report.time = reader.number(is_implicit ? "time" : "time before");
  if (!problem_.scheme().has_inertia() && reader.has("kinetic energy"))
    report.kinetic_energy = reader.number("kinetic energy");
  for (std::size_t b = 0; b < problem_.scene().bodies().size(); ++b)
    load_body(b, reader, report);
  load_tools(reader, nodes);
  load_contacts(reader, keys);
  update_contacts(reader, report.is_exact);
  problem_.scales().spring_round_off =
      problem_.contacts().find_spring_round_off(); // of penalties as they are
  if (is_own)
    load_own(reader, nodes, report.is_exact);
  if (!report.is_exact)
    balance(report);
  rules_->finish_load(reader, release_time, report);
  report.release_end = problem_.released().are_there() ? problem_.released().end() : state.time;
  return report;
}

void ImplicitSolution::load_body(const std::size_t body, StateReader &reader, RestartReport &report) {
  const Discretization &discretization = problem_.discretization();
  const Vector &displacements = state().displacements;
  reader.in(group("body", body), [&] {
    ElementBlock &block = problem_.internal().block(body);
    const ElementFormulation &formulation = problem_.scene().bodies()[body].formulation;
    bool is_same =
        reader.read_text("formulation") == describe(formulation, *problem_.scene().bodies()[body].law);
    if (is_same && formulation.points_through > 2)
      is_same = problem_.on_all_ranks(load_thickness_axes(reader, element_keys(discretization, body)) ==
                                      block.thickness_axes());
    if (is_same) {
      const std::size_t width = block.state_size();
      if (width == 0)
        return;
      const auto rows = reader.read_rows("history", width, element_keys(discretization, body));
      for (std::size_t e = 0; e < block.size(); ++e)
        block.set_state(e, rows.data() + width * e);
      return;
    }
    report.is_exact = false;
    const auto stresses = load_stress(reader, problem_.scene(), body, discretization, displacements);
    for (std::size_t e = 0; e < block.size(); ++e)
      block.set_stress(e, gather(displacements, discretization.elements(body)[e].dofs), stresses[e]);
  });
}

void ImplicitSolution::load_own(StateReader &reader, const OwnedNodes &nodes, const bool is_exact) {
  StepState &step = problem_.step();
  load_nodal(reader, "increment", nodes, step.last_increment);
  load_nodal(reader, "support forces", nodes, step.start.supports);
  load_nodal(reader, "contact forces", nodes, step.start.contact);
  load_nodal(reader, "internal forces", nodes, step.start.internal);
  round_off_.load(reader);
  books_.load(reader);
  rules_->load(reader, is_exact);
  if (is_exact)
    augmentation_.load(reader);
  rules_->predictor().load(reader, nodes, is_exact);
  if (reader.has("exact tangent"))
    problem_.tangent().take_exact();
  problem_.scales().lasting = reader.read("scales").at(0);
  problem_.released().load(reader, nodes, problem_.discretization());
}

void ImplicitSolution::load_tools(StateReader &reader, const OwnedNodes &nodes) {
  const auto &tools = problem_.scene().tools();
  SolutionState &state = problem_.state();
  problem_.tools().begin();
  for (std::size_t i = 0; i < tools.size(); ++i) {
    state.placements[i] = tools[i].placement(state.time);
    const auto found = find_group(reader, "tool", tools[i].name());
    if (!found)
      continue;
    reader.in(group("tool", *found), [&] {
      state.placements[i] = to_placement(reader.read("placement"));
      state.tool_loads[i] = to_contact_load(reader.read("load"));
      problem_.tools().load(i, reader, state.placements[i]);
      problem_.removal().load(i, reader, nodes);
    });
  }
  problem_.tools().restart();
}

void ImplicitSolution::load_contacts(StateReader &reader, const NodeKeys &keys) {
  SolutionState &state = problem_.state();
  auto body_pair_load = state.body_pair_loads.begin();
  for (auto &contact : problem_.contacts()) {
    ContactLoad *const load = contact.rigid_tool() ? nullptr : &*body_pair_load++;
    const bool is_known = load_pair(reader, contact, [&] {
      contact.load(reader, keys);
      if (load != nullptr && reader.has("load"))
        *load = to_contact_load(reader.read("load"));
    });
    if (!is_known)
      contact.begin({state.time, state.time, 0., state.placements, state.placements}, state.displacements);
  }
}

void ImplicitSolution::update_contacts(StateReader &reader, const bool is_exact) {
  if (problem_.contacts().of_bodies().empty())
    return;
  bool couplings_are_known = is_exact;
  problem_.start_at_rest();
  for (auto &contact : problem_.contacts().of_bodies()) {
    contact.update(state().displacements);
    if (couplings_are_known)
      load_pair(reader, contact, [&] { couplings_are_known = contact.load_couplings(reader); });
  }
  problem_.tangent().build(couplings_are_known);
}

void ImplicitSolution::balance(RestartReport &report) {
  problem_.start_at_rest();
  problem_.released().clear();
  problem_.tools().choose_unknown({});
  StepState &step = problem_.step();
  SolutionState &state = problem_.state();
  Vector residual = problem_.discretization().make_owned_vector();
  if (!problem_.compute_residual(step.start.displacements, residual))
    throw InputError("its state is not admissible here: elements are inside out, or forces not finite");
  report.imbalance = residual.l2_norm();
  report.force_scale = problem_.force_scale();
  problem_.scales().lasting = std::max(problem_.scales().lasting, 1e-3 * problem_.force_scale());
  step.start.supports = step.trial.supports;
  step.start.contact = step.trial.contact;
  step.start.internal = step.trial.internal;
  const Contacts::Loads loads = problem_.contacts().compute_loads();
  state.tool_loads = loads.of_tools;
  state.body_pair_loads = loads.of_body_pairs;
  state.energies.contact = 0.;
  for (const auto *of : {&loads.of_tools, &loads.of_body_pairs})
    for (const ContactLoad &load : *of)
      state.energies.contact += load.stored_energy;
  // What has gone with the interruption is no drift.
  EnergyLedger &energies = state.energies;
  const double drift = energies.drift();
  const auto now = problem_.internal().compute_energies(state.displacements);
  if (!problem_.scheme().has_inertia())
    energies.kinetic = 0.;
  energies.hourglass = now.hourglass;
  energies.elastic = now.elastic;
  energies.plastic = now.plastic;
  energies.initial += drift - energies.drift();
  rules_->hold_imbalance(residual);
}

} // namespace billet
