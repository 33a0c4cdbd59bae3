// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/pressure_record.h"

#include <algorithm>

namespace billet {

namespace {

constexpr std::size_t pressure_row_width = 8; // of a node

} // namespace

bool PressureRecord::has_pressure() const {
  return is_known_ && std::any_of(entries_.begin(), entries_.end(),
                                  [](const Entry &entry) { return entry.pressure > 0.; });
}

void PressureRecord::record(const std::vector<ToolContactState> &states,
                            const std::vector<ContactPoint> &nodes, const Placement &placement) {
  is_known_ = true;
  entries_.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    entries_[i].pressure = states[i].pressure;
    entries_[i].penetration = pressed_depth(states[i], nodes[i]);
    entries_[i].normal = dealii::transpose(placement.rotation) * states[i].normal;
    entries_[i].position = placement.to_tool(states[i].position);
  }
}

void PressureRecord::save(StateWriter &writer, const SlaveSurface::Range &range) const {
  if (!is_known_)
    return;
  std::vector<double> rows;
  RowWriter row(rows);
  for (std::size_t i = range.begin; i < range.end; ++i)
    row.number(entries_[i].pressure)
        .number(entries_[i].penetration)
        .vector(entries_[i].normal)
        .vector(entries_[i].position);
  range.write(writer, "pressed", pressure_row_width, rows);
}

void PressureRecord::load(const StateReader &reader, const SlaveSurface::Range &range) {
  if (!is_known_)
    return;
  range.read(reader, "pressed", pressure_row_width, [&](const std::size_t i, RowReader &row) {
    entries_[i].pressure = row.number();
    entries_[i].penetration = row.number();
    row.vector(entries_[i].normal);
    row.vector(entries_[i].position);
  });
}

} // namespace billet
