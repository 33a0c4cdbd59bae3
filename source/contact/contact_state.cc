// SPDX-License-Identifier: LGPL-2.1-or-later
// What contact keeps from step to step, given to a checkpoint and taken back.
#include "billet/contact/facet_contact.h"
#include "billet/contact/rigid_contact.h"

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

constexpr std::size_t gap_width = 2, friction_width = 20; // of a node on a tool
constexpr std::size_t touch_width = 9, slave_width = 17;  // of a node on facets

// A facet's key has more bits than a double keeps.
constexpr std::uint64_t half_key = 0xffffffffU;

} // namespace

void RigidContact::save(StateWriter &writer, const NodeKeys &keys) const {
  std::vector<std::uint64_t> node_keys;
  std::vector<double> gaps, friction;
  RowWriter gap_row(gaps), friction_row(friction);
  for (const auto &node : nodes_) {
    node_keys.push_back(keys(node.dofs[0]));
    gap_row.number(node.gap_n).number(node.patch);
  }
  for (const auto &history : friction_n_) {
    friction_row.number(history.is_active ? 1. : 0.);
    store(history.frame, friction_row);
    friction_row.number(history.tangential[0]).number(history.tangential[1]);
    friction_row.vector(history.tool_position).number(history.slip).number(history.slip_rate);
  }
  writer.write("removed", {is_removed_ ? 1. : 0.});
  writer.write_rows("gaps", gap_width, node_keys, gaps);
  if (pair_.has_friction())
    writer.write_rows("friction", friction_width, node_keys, friction);
}

void RigidContact::load(const StateReader &reader, const NodeKeys &keys) {
  if (reader.number("removed") != 0.)
    remove_tool();
  std::vector<std::uint64_t> node_keys;
  for (const auto &node : nodes_)
    node_keys.push_back(keys(node.dofs[0]));
  const std::vector<double> gaps = reader.read_rows("gaps", gap_width, node_keys);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    RowReader row(&gaps[gap_width * i]);
    nodes_[i].gap_n = row.number();
    nodes_[i].patch = static_cast<unsigned int>(row.number());
  }
  if (!pair_.has_friction() || !reader.has("friction")) // a law that is new begins without traction
    return;
  const std::vector<double> friction = reader.read_rows("friction", friction_width, node_keys);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    RowReader row(&friction[friction_width * i]);
    FrictionHistory &history = friction_n_[i];
    history.is_active = row.flag();
    restore(row, history.frame);
    history.tangential[0] = row.number();
    history.tangential[1] = row.number();
    row.vector(history.tool_position);
    history.slip = row.number();
    history.slip_rate = row.number();
  }
  friction_ = friction_n_;
}

template <class DisplacementOf>
void RigidContact::begin_at(const Placement &placement, const DisplacementOf &displacement_of) {
  placement_n_ = placement_ = placement;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const dealii::Tensor<1, 3> position = nodes_[i].reference + displacement_of(i);
    const dealii::Tensor<1, 3> on_tool = placement.to_tool(position);
    const auto projection = tool_.surface().project(on_tool);
    states_[i] = NodeState();
    states_[i].position = position;
    states_[i].gap = nodes_[i].gap_n = projection.gap;
    nodes_[i].patch = projection.patch;
    if (!friction_n_.empty()) {
      friction_n_[i] = FrictionHistory();
      friction_n_[i].tool_position = on_tool;
    }
  }
  friction_ = friction_n_;
}

void RigidContact::begin(const Placement &placement, const Vector &displacements) {
  begin_at(placement, [&](const std::size_t i) {
    dealii::Tensor<1, 3> displacement;
    for (unsigned int c = 0; c < 3; ++c)
      displacement[c] = displacements(nodes_[i].dofs[c]);
    return displacement;
  });
}

void RigidContact::begin(const Placement &placement, const NodalVectors &displacements) {
  begin_at(placement, [&](const std::size_t i) { return get_vector(displacements.data(), local_nodes_[i]); });
}

void FacetContact::save(StateWriter &writer) const {
  std::vector<std::uint64_t> keys;
  std::vector<double> touches, histories;
  RowWriter touch_row(touches), history_row(histories);
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    keys.push_back(exchange_.node_keys()[slaves_[s].node]);
    const TouchedFacet &touched = touched_n_[s];
    const std::uint64_t key = !touched.exists()         ? 0
                              : !restored_keys_.empty() ? restored_keys_[s]
                                                        : search_.facets()[touched.facet].key;
    touch_row.number(touched.exists() ? 1. : 0.)
        .number(static_cast<double>(key >> 32U))
        .number(static_cast<double>(key & half_key))
        .number(touched.offset)
        .number(touched.projection.parameters[0])
        .number(touched.projection.parameters[1])
        .vector(touched.projection.normal);
    if (history_n_.empty())
      continue;
    const SlaveHistory &history = history_n_[s];
    history_row.number(history.is_active ? 1. : 0.);
    store(history.frame, history_row);
    history_row.number(history.tangential[0]).number(history.tangential[1]);
    history_row.number(history.slip).number(history.slip_rate);
  }
  writer.write_rows("touched", touch_width, keys, touches);
  if (!std::holds_alternative<Frictionless>(settings_.friction))
    writer.write_rows("friction", slave_width, keys, histories);
}

void FacetContact::load(const StateReader &reader) {
  std::vector<std::uint64_t> keys;
  for (const auto &slave : slaves_)
    keys.push_back(exchange_.node_keys()[slave.node]);
  // Of a pair that was in one pass before, slaves may be new.
  std::vector<bool> is_known;
  const std::vector<double> touches = reader.read_rows("touched", touch_width, keys, &is_known);
  restored_keys_.assign(slaves_.size(), 0);
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    RowReader row(&touches[touch_width * s]);
    TouchedFacet &touched = touched_n_[s];
    touched = TouchedFacet();
    if (row.flag())
      touched.facet = 0; // which one, rebuild() finds by its key
    const auto high = static_cast<std::uint64_t>(row.number());
    restored_keys_[s] = (high << 32U) | static_cast<std::uint64_t>(row.number());
    touched.offset = row.number();
    touched.projection.parameters[0] = row.number();
    touched.projection.parameters[1] = row.number();
    row.vector(touched.projection.normal);
  }
  if (history_n_.empty() || !reader.has("friction"))
    return;
  const std::vector<double> histories = reader.read_rows("friction", slave_width, keys, &is_known);
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    RowReader row(&histories[slave_width * s]);
    SlaveHistory &history = history_n_[s];
    history.is_active = row.flag();
    restore(row, history.frame);
    history.tangential[0] = row.number();
    history.tangential[1] = row.number();
    history.slip = row.number();
    history.slip_rate = row.number();
  }
  history_ = history_n_;
}

} // namespace billet
