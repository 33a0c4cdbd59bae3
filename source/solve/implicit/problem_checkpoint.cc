// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/problem_checkpoint.h"

#include "billet/solve/refined_reader.h"

#include <vector>

namespace billet {

void ProblemCheckpoint::save_bodies(StateWriter &writer) const {
  for (std::size_t b = 0; b < parts_.scene().bodies().size(); ++b)
    writer.in(group("body", b), [&] { save_body(b, writer); });
}

void ProblemCheckpoint::save_tools(StateWriter &writer, const OwnedNodes &nodes) const {
  const SolutionState &state = problem_.state();
  for (std::size_t i = 0; i < parts_.scene().tools().size(); ++i)
    writer.in(group("tool", i), [&] {
      parts_.tools().save(i, state.placements[i], writer);
      writer.write("flags",
                   {parts_.tools().is_stopped(i) ? 1. : 0., parts_.removal().is_removed(i) ? 1. : 0.});
      writer.write("load", to_numbers(state.tool_loads[i]));
      parts_.scheme().tools().save(i, writer);
      parts_.removal().save(i, writer, nodes);
    });
}

void ProblemCheckpoint::save_body(const std::size_t body, StateWriter &writer) const {
  const ElementFormulation &formulation = parts_.scene().bodies()[body].formulation;
  save_format(writer, format_of(formulation, *parts_.scene().bodies()[body].law));
  const ElementBlock &block = parts_.internal().block(body);
  const std::vector<std::uint64_t> keys = element_keys(parts_.discretization(), body);
  if (formulation.points_through > 2)
    save_thickness_axes(writer, block, keys);
  const std::size_t width = block.state_size();
  if (width == 0)
    return;
  std::vector<double> rows(width * block.size());
  for (std::size_t e = 0; e < block.size(); ++e)
    block.get_state(e, rows.data() + width * e);
  save_fields(writer, *parts_.scene().bodies()[body].law);
  writer.write_rows("history", width, keys, rows);
}

void ProblemCheckpoint::save_contacts(StateWriter &writer, const NodeKeys &keys) const {
  auto body_pair_load = problem_.state().body_pair_loads.begin();
  for (const auto &contact : parts_.contacts())
    writer.in(group(contact.group_kind(), contact.group_index()), [&] {
      save_pair(writer, contact);
      if (!contact.rigid_tool())
        writer.write("load", to_numbers(*body_pair_load++));
      contact.save(writer, keys);
      contact.with_matrix().couplings().save(writer);
    });
}

void ProblemCheckpoint::load_bodies(StateReader &reader, RestartReport &report) {
  for (std::size_t b = 0; b < parts_.scene().bodies().size(); ++b)
    reader.in(group("body", b), [&] {
      const bool is_same = load_body(b, reader);
      report.is_exact = report.is_exact && is_same;
    });
}

bool ProblemCheckpoint::load_body(const std::size_t body, StateReader &reader) {
  const Discretization &discretization = parts_.discretization();
  const Vector &displacements = problem_.state().displacements;
  ElementBlock &block = parts_.internal().block(body);
  const ElementFormulation &formulation = parts_.scene().bodies()[body].formulation;
  bool is_same = load_format(reader) == format_of(formulation, *parts_.scene().bodies()[body].law);
  if (is_same && formulation.points_through > 2)
    is_same = problem_.on_all_ranks(load_thickness_axes(reader, element_keys(discretization, body)) ==
                                    block.thickness_axes());
  if (!is_same) {
    const auto stresses =
        load_stress(reader, parts_.scene(), body, discretization, displacements, problem_.state().time);
    for (std::size_t e = 0; e < block.size(); ++e)
      block.set_stress(e, gather(displacements, discretization.elements(body)[e].dofs), stresses[e]);
    return false;
  }
  const std::size_t width = block.state_size();
  if (width == 0)
    return true;
  const Body &scene_body = parts_.scene().bodies()[body];
  const auto rows = load_history(reader, scene_body.name, *scene_body.law, block.point_states(), width,
                                 element_keys(discretization, body));
  const std::vector<bool> are_refined = refined_bodies(reader);
  for (std::size_t e = 0; e < block.size(); ++e)
    if (are_refined.empty() || !are_refined[body])
      block.set_state(e, rows.data() + width * e);
    else
      block.set_parent_state(e, rows.data() + width * e,
                             child_number(element_key(discretization.elements(body)[e].cell)));
  return true;
}

void ProblemCheckpoint::load_tools(StateReader &reader, const OwnedNodes &nodes) {
  const auto &tools = parts_.scene().tools();
  SolutionState &state = problem_.state();
  parts_.tools().begin();
  for (std::size_t i = 0; i < tools.size(); ++i) {
    state.placements[i] = tools[i].placement(state.time);
    const auto found = find_group(reader, "tool", tools[i].name());
    if (!found)
      continue;
    reader.in(group("tool", *found), [&] {
      state.placements[i] = to_placement(reader.read("placement"));
      state.tool_loads[i] = to_contact_load(reader.read("load"));
      parts_.tools().load(i, reader, state.placements[i]);
      parts_.removal().load(i, reader, nodes);
    });
  }
  parts_.tools().restart();
}

void ProblemCheckpoint::load_contacts(StateReader &reader, const NodeKeys &keys) {
  SolutionState &state = problem_.state();
  auto body_pair_load = state.body_pair_loads.begin();
  for (auto &contact : parts_.contacts()) {
    ContactLoad *const load = contact.rigid_tool() ? nullptr : &*body_pair_load++;
    const ContactStep at{state.time, state.time, 0., state.placements, state.placements};
    // Contact keeps its initial state where the coarser mesh has no data.
    const bool begins = is_refined(reader, contact);
    if (begins)
      contact.with_matrix().begin(at, state.displacements);
    const bool is_known = load_pair(reader, contact, [&] {
      contact.load(reader, keys);
      if (load != nullptr && reader.has("load"))
        *load = to_contact_load(reader.read("load"));
    });
    if (!is_known && !begins)
      contact.with_matrix().begin(at, state.displacements);
    contact.fade_gaps(state.time, end_of_fading(parts_.scene().parameters(), state.time), begins);
  }
}

void ProblemCheckpoint::update_contacts(StateReader &reader, const bool is_exact) {
  if (parts_.contacts().of_bodies().empty())
    return;
  bool couplings_are_known = is_exact;
  problem_.start_at_rest();
  for (auto &contact : parts_.contacts().of_bodies()) {
    contact.with_matrix().update(problem_.state().displacements);
    if (couplings_are_known)
      load_pair(reader, contact,
                [&] { couplings_are_known = contact.with_matrix().couplings().load(reader); });
  }
  parts_.tangent().build(couplings_are_known);
}

} // namespace billet
