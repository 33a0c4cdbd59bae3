// SPDX-License-Identifier: LGPL-2.1-or-later Saves the contact state to checkpoints and loads it.
#include "billet/contact/rigid_contact.h"

#include <algorithm>

namespace billet {

namespace {

void store(const Frame &frame, RowWriter &row) {
  row.vector(frame.q).vector(frame.r).vector(frame.n).vector(frame.spin);
}

void restore(RowReader &row, Frame &frame) {
  row.vector(frame.q);
  row.vector(frame.r);
  row.vector(frame.n);
  row.vector(frame.spin);
}

constexpr std::size_t pressed_width = 8;                  // of a node that may press
constexpr std::size_t gap_width = 4, friction_width = 20; // of a node on a tool
constexpr std::size_t behind_width = 4;                   // of a node that may be behind a tool
constexpr std::size_t areas_width = 4;                    // of a facet

} // namespace

void RigidContact::save_nodes(StateWriter &writer, const SlaveSurface::Range &range) const {
  std::vector<double> gaps, friction, behind;
  RowWriter gap_row(gaps), friction_row(friction), behind_row(behind);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const ContactPoint &node = slaves_.nodes[i];
    gap_row.number(node.gap_n).number(node.patch).number(node.lift_n).number(node.initial_depth);
    behind_row.number(node.is_behind ? 1. : 0.).vector(node.behind_at);
    if (!pair_.has_friction())
      continue;
    const FrictionHistory &history = friction_n_[i];
    friction_row.number(history.is_active ? 1. : 0.);
    store(history.frame, friction_row);
    friction_row.number(history.tangential[0]).number(history.tangential[1]);
    friction_row.vector(history.tool_position).number(history.slip).number(history.slip_rate);
  }
  if (knows_pressures_) {
    std::vector<double> pressed;
    RowWriter row(pressed);
    for (std::size_t i = range.begin; i < range.end; ++i)
      row.number(pressed_n_[i].pressure)
          .number(pressed_n_[i].depth)
          .vector(pressed_n_[i].normal)
          .vector(pressed_n_[i].position);
    writer.write_rows(range.prefix + "pressed", pressed_width, range.keys, pressed);
  }
  writer.write_rows(range.prefix + "gaps", gap_width, range.keys, gaps);
  if (pair_.has_friction())
    writer.write_rows(range.prefix + "friction", friction_width, range.keys, friction);
  if (has_inertia_)
    writer.write_rows(range.prefix + "behind", behind_width, range.keys, behind);
}

std::vector<RigidContact::KeptAreas> RigidContact::kept_areas() const {
  std::vector<KeptAreas> kept;
  if (is_explicit_)
    kept.push_back({"shallow areas", &ContactFacet::shallow_areas});
  else if (pair_.has_friction())
    kept.push_back({"friction areas", &ContactFacet::friction_areas});
  return kept;
}

void RigidContact::save_areas(StateWriter &writer, const std::string &name, const CornerAreas areas,
                              const SlaveSurface::Range &range) const {
  std::vector<double> rows;
  for (std::size_t f = range.begin; f < range.end; ++f)
    rows.insert(rows.end(), (slaves_.facets[f].*areas).begin(), (slaves_.facets[f].*areas).end());
  writer.write_rows(range.prefix + name, areas_width, range.keys, rows);
}

void RigidContact::save(StateWriter &writer, const NodeKeys &keys) const {
  writer.write("removed", {is_removed_ ? 1. : 0.});
  writer.write("allowed part", {allowed_part_});
  writer.write("stiffening", {stiffening_, tangential_stiffening_});
  save_nodes(writer, slaves_.mesh_nodes(keys));
  if (slaves_.has_divided_facets)
    save_nodes(writer, slaves_.interior_points());
  for (const auto &[name, areas] : kept_areas()) {
    save_areas(writer, name, areas, slaves_.facet_range(false));
    if (slaves_.has_divided_facets)
      save_areas(writer, name, areas, slaves_.facet_range(true));
  }
}

void RigidContact::load_nodes(const StateReader &reader, const SlaveSurface::Range &range) {
  // With another tool or mesh before the restart, the points inside facets may have been different.
  std::vector<bool> is_known(range.keys.size(), true);
  std::vector<bool> *const found = range.prefix.empty() ? nullptr : &is_known;
  if (knows_pressures_) {
    const std::vector<double> pressed =
        reader.read_rows(range.prefix + "pressed", pressed_width, range.keys, found);
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (!is_known[i - range.begin])
        continue;
      RowReader row(&pressed[pressed_width * (i - range.begin)]);
      pressed_n_[i].pressure = row.number();
      pressed_n_[i].depth = row.number();
      row.vector(pressed_n_[i].normal);
      row.vector(pressed_n_[i].position);
    }
  }
  const std::vector<double> gaps = reader.read_rows(range.prefix + "gaps", gap_width, range.keys, found);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    if (!is_known[i - range.begin])
      continue;
    RowReader row(&gaps[gap_width * (i - range.begin)]);
    slaves_.nodes[i].gap_n = row.number();
    slaves_.nodes[i].patch = static_cast<unsigned int>(row.number());
    slaves_.nodes[i].lift = slaves_.nodes[i].lift_n = row.number();
    slaves_.nodes[i].initial_depth = row.number();
  }
  if (has_inertia_ && reader.has(range.prefix + "behind")) {
    const std::vector<double> behind =
        reader.read_rows(range.prefix + "behind", behind_width, range.keys, found);
    for (std::size_t i = range.begin; i < range.end; ++i) {
      RowReader row(&behind[behind_width * (i - range.begin)]);
      slaves_.nodes[i].is_behind = row.flag();
      row.vector(slaves_.nodes[i].behind_at);
    }
  }
  // A new friction law begins without traction.
  if (!pair_.has_friction() || !reader.has(range.prefix + "friction"))
    return;
  const std::vector<double> friction =
      reader.read_rows(range.prefix + "friction", friction_width, range.keys, found);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    if (!is_known[i - range.begin])
      continue;
    RowReader row(&friction[friction_width * (i - range.begin)]);
    FrictionHistory &history = friction_n_[i];
    history.is_active = row.flag();
    restore(row, history.frame);
    history.tangential[0] = row.number();
    history.tangential[1] = row.number();
    row.vector(history.tool_position);
    history.slip = row.number();
    history.slip_rate = row.number();
  }
}

void RigidContact::load_areas(const StateReader &reader, const std::string &name, const CornerAreas areas,
                              const SlaveSurface::Range &range) {
  if (!reader.has(range.prefix + name))
    return;
  std::vector<bool> is_known(range.keys.size(), true);
  const std::vector<double> rows = reader.read_rows(range.prefix + name, areas_width, range.keys,
                                                    range.prefix.empty() ? nullptr : &is_known);
  for (std::size_t f = range.begin; f < range.end; ++f)
    if (is_known[f - range.begin])
      std::copy_n(&rows[areas_width * (f - range.begin)], areas_width, (slaves_.facets[f].*areas).begin());
}

void RigidContact::load(const StateReader &reader, const NodeKeys &keys) {
  if (reader.number("removed") != 0.)
    remove_tool();
  allowed_part_ = allowed_part_n_ = reader.number("allowed part");
  if (thin_tool_)
    thin_tool_->forget();
  if (reader.has("stiffening")) {
    const std::vector<double> factors = reader.read("stiffening");
    scale_penalties(factors.at(0) / stiffening_, factors.at(1) / tangential_stiffening_);
  }
  knows_pressures_ = !is_explicit_ && reader.has("pressed");
  load_nodes(reader, slaves_.mesh_nodes(keys));
  if (slaves_.has_divided_facets && reader.has("interior gaps"))
    load_nodes(reader, slaves_.interior_points());
  for (auto &divided : slaves_.divided)
    divided.may_touch = true;
  friction_ = friction_n_;
  for (const auto &[name, areas] : kept_areas()) {
    load_areas(reader, name, areas, slaves_.facet_range(false));
    if (slaves_.has_divided_facets)
      load_areas(reader, name, areas, slaves_.facet_range(true));
  }
}

template <class DisplacementOf>
void RigidContact::begin_at(const ContactStep &step, const DisplacementOf &displacement_of) {
  const Placement &placement = step.tools_at_start[pair_.tool];
  placement_n_ = placement_ = placement;
  allowed_part_ = pair_.overlap.allowed_part(step.start);
  for (auto &divided : slaves_.divided)
    divided.may_touch = true;
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i) {
    const dealii::Tensor<1, 3> position = slaves_.nodes[i].reference + slaves_.at(i, displacement_of);
    const dealii::Tensor<1, 3> on_tool = placement.to_tool(position);
    const auto projection = tool_.surface().project(on_tool);
    states_[i] = ToolContactState();
    states_[i].position = position;
    slaves_.nodes[i].lift = slaves_.nodes[i].lift_n = slaves_.nodes[i].initial_depth = 0.;
    slaves_.nodes[i].is_behind = false;
    if (projection.exists &&
        ((pair_.overlap.is_allowed && projection.gap < 0.) || pair_.overlap.closes(projection.gap)))
      slaves_.nodes[i].initial_depth = -projection.gap;
    states_[i].gap = slaves_.nodes[i].gap_n = projection.gap - lift_of(slaves_.nodes[i]);
    slaves_.nodes[i].patch = projection.patch;
    if (!friction_n_.empty()) {
      friction_n_[i] = FrictionHistory();
      friction_n_[i].tool_position = on_tool;
    }
  }
  friction_ = friction_n_;
  remember_positions();
  remember_pressures();
  for (auto &facet : slaves_.facets) {
    facet.shallow_areas.fill(SpringEnergy::no_area);
    facet.friction_areas.fill(0.);
  }
}

void RigidContact::begin(const ContactStep &step, const Vector &displacements) {
  begin_at(step, [&](const std::size_t i) {
    dealii::Tensor<1, 3> displacement;
    for (unsigned int c = 0; c < 3; ++c)
      displacement[c] = displacements(slaves_.nodes[i].dofs[c]);
    return displacement;
  });
}

void RigidContact::begin(const ContactStep &step, const NodalVectors &displacements) {
  begin_at(step, [&](const std::size_t i) { return get_vector(displacements.data(), local_nodes_[i]); });
}

} // namespace billet
