// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/tool_checkpoint.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace billet {

namespace {

constexpr std::size_t gap_width = 4;   // of a node
constexpr std::size_t areas_width = 4; // of a facet

/// Areas of a facet's corners, and their names.
using CornerAreas = std::array<double, 4> ContactFacet::*;
using KeptAreas = std::pair<std::string, CornerAreas>;

std::vector<KeptAreas> kept_areas(const RigidContactParts &parts) {
  std::vector<KeptAreas> kept;
  if (parts.is_explicit)
    kept.push_back({"shallow areas", &ContactFacet::shallow_areas});
  else if (parts.friction)
    kept.push_back({"friction areas", &ContactFacet::friction_areas});
  return kept;
}

void save_nodes(const RigidContactParts &parts, const SlaveSurface::Range &range, StateWriter &writer) {
  parts.pressures.save(writer, range);
  std::vector<double> gaps;
  RowWriter row(gaps);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const ContactPoint &node = parts.slaves.nodes[i];
    row.number(node.gap_n)
        .number(node.patch)
        .number(node.multiplier_offset_n)
        .number(node.initial_penetration);
  }
  range.write(writer, "gaps", gap_width, gaps);
  if (parts.friction)
    parts.friction->save(writer, range);
  if (parts.has_inertia)
    MissedEdge::save(writer, parts.slaves.nodes, range);
}

void save_areas(const RigidContactParts &parts, const KeptAreas &kept, const SlaveSurface::Range &range,
                StateWriter &writer) {
  std::vector<double> rows;
  for (std::size_t f = range.begin; f < range.end; ++f) {
    const std::array<double, 4> &areas = parts.slaves.facets[f].*kept.second;
    rows.insert(rows.end(), areas.begin(), areas.end());
  }
  range.write(writer, kept.first, areas_width, rows);
}

void load_nodes(const StateReader &reader, const SlaveSurface::Range &range, RigidContactParts &parts) {
  parts.pressures.load(reader, range);
  range.read(reader, "gaps", gap_width, [&](const std::size_t i, RowReader &row) {
    ContactPoint &node = parts.slaves.nodes[i];
    node.gap_n = row.number();
    node.patch = to_count(row.number());
    node.multiplier_offset = node.multiplier_offset_n = row.number();
    node.initial_penetration = row.number();
  });
  if (parts.has_inertia)
    MissedEdge::load(reader, parts.slaves.nodes, range);
  if (parts.friction)
    parts.friction->load(reader, range);
}

void load_areas(const StateReader &reader, const KeptAreas &kept, const SlaveSurface::Range &range,
                RigidContactParts &parts) {
  if (!reader.has(range.prefix + kept.first))
    return;
  range.read(reader, kept.first, areas_width, [&](const std::size_t f, RowReader &row) {
    for (double &area : parts.slaves.facets[f].*kept.second)
      area = row.number();
  });
}

} // namespace

void save_tool_contact(const RigidContactParts &parts, const ToolPenalties &penalties, StateWriter &writer,
                       const NodeKeys &keys) {
  const SlaveSurface &slaves = parts.slaves;
  writer.write("removed", {parts.step.is_removed ? 1. : 0.});
  writer.write("allowed part", {parts.step.allowed_part});
  if (parts.fading_gaps)
    writer.write("fading gaps", {parts.fading_gaps->begin, parts.fading_gaps->end});
  writer.write("stiffening", {penalties.stiffening(), penalties.tangential_stiffening()});
  save_nodes(parts, slaves.mesh_nodes(keys), writer);
  if (slaves.has_divided_facets)
    save_nodes(parts, slaves.interior_points(), writer);
  for (const auto &kept : kept_areas(parts)) {
    save_areas(parts, kept, slaves.facet_range(false), writer);
    if (slaves.has_divided_facets)
      save_areas(parts, kept, slaves.facet_range(true), writer);
  }
}

void load_tool_contact(const StateReader &reader, const NodeKeys &keys, RigidContactParts &parts,
                       ToolPenalties &penalties) {
  SlaveSurface &slaves = parts.slaves;
  if (reader.number("removed") != 0.)
    parts.remove_tool();
  parts.step.allowed_part = parts.step.allowed_part_n = reader.number("allowed part");
  if (reader.has("fading gaps")) {
    const std::vector<double> times = reader.read("fading gaps", 2);
    parts.fading_gaps = FadingGaps{times.at(0), times.at(1)};
  }
  if (parts.thin_tool)
    parts.thin_tool->forget();
  if (reader.has("stiffening")) {
    const std::vector<double> factors = reader.read("stiffening", 2);
    penalties.scale(factors.at(0) / penalties.stiffening(),
                    factors.at(1) / penalties.tangential_stiffening());
  }
  parts.pressures.set_known(!parts.is_explicit && reader.has("pressed"));
  load_nodes(reader, slaves.mesh_nodes(keys), parts);
  if (slaves.has_divided_facets && reader.has("interior gaps"))
    load_nodes(reader, slaves.interior_points(), parts);
  for (auto &divided : slaves.divided)
    divided.may_touch = true;
  if (parts.friction)
    parts.friction->commit();
  for (const auto &kept : kept_areas(parts)) {
    load_areas(reader, kept, slaves.facet_range(false), parts);
    if (slaves.has_divided_facets)
      load_areas(reader, kept, slaves.facet_range(true), parts);
  }
}

} // namespace billet
