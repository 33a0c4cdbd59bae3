// SPDX-License-Identifier: LGPL-2.1-or-later
// What contact keeps from step to step, given to a checkpoint and taken back.
#include "billet/contact/facet_contact.h"
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

constexpr std::size_t gap_width = 4, friction_width = 20; // of a node on a tool
constexpr std::size_t behind_width = 4;                   // of a node that may be behind a tool
constexpr std::size_t areas_width = 4;                    // of a facet
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
    gap_row.number(node.gap_n).number(node.patch).number(node.lift_n).number(node.initial_depth);
  }
  for (const auto &history : friction_n_) {
    friction_row.number(history.is_active ? 1. : 0.);
    store(history.frame, friction_row);
    friction_row.number(history.tangential[0]).number(history.tangential[1]);
    friction_row.vector(history.tool_position).number(history.slip).number(history.slip_rate);
  }
  writer.write("removed", {is_removed_ ? 1. : 0.});
  writer.write("allowed part", {allowed_part_});
  writer.write("stiffening", {stiffening_});
  writer.write_rows("gaps", gap_width, node_keys, gaps);
  if (pair_.has_friction())
    writer.write_rows("friction", friction_width, node_keys, friction);
  if (has_inertia_) {
    std::vector<double> behind;
    RowWriter behind_row(behind);
    for (const auto &node : nodes_)
      behind_row.number(node.is_behind ? 1. : 0.).vector(node.behind_at);
    writer.write_rows("behind", behind_width, node_keys, behind);
  }
  if (!is_explicit_)
    return;
  std::vector<std::uint64_t> facet_keys;
  std::vector<double> areas;
  for (const auto &facet : facets_) {
    facet_keys.push_back(facet.key);
    areas.insert(areas.end(), facet.shallow_areas.begin(), facet.shallow_areas.end());
  }
  writer.write_rows("shallow areas", areas_width, facet_keys, areas);
}

void RigidContact::load(const StateReader &reader, const NodeKeys &keys) {
  if (reader.number("removed") != 0.)
    remove_tool();
  allowed_part_ = reader.number("allowed part");
  positions_on_thin_tool_.clear();
  if (reader.has("stiffening"))
    stiffen(reader.number("stiffening") / stiffening_);
  std::vector<std::uint64_t> node_keys;
  for (const auto &node : nodes_)
    node_keys.push_back(keys(node.dofs[0]));
  const std::vector<double> gaps = reader.read_rows("gaps", gap_width, node_keys);
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    RowReader row(&gaps[gap_width * i]);
    nodes_[i].gap_n = row.number();
    nodes_[i].patch = static_cast<unsigned int>(row.number());
    nodes_[i].lift = nodes_[i].lift_n = row.number();
    nodes_[i].initial_depth = row.number();
  }
  if (has_inertia_ && reader.has("behind")) {
    const std::vector<double> behind = reader.read_rows("behind", behind_width, node_keys);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      RowReader row(&behind[behind_width * i]);
      nodes_[i].is_behind = row.flag();
      row.vector(nodes_[i].behind_at);
    }
  }
  if (is_explicit_ && reader.has("shallow areas")) {
    std::vector<std::uint64_t> facet_keys;
    for (const auto &facet : facets_)
      facet_keys.push_back(facet.key);
    const std::vector<double> areas = reader.read_rows("shallow areas", areas_width, facet_keys);
    for (std::size_t f = 0; f < facets_.size(); ++f)
      std::copy_n(&areas[areas_width * f], areas_width, facets_[f].shallow_areas.begin());
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
    nodes_[i].lift = nodes_[i].lift_n = nodes_[i].initial_depth = 0.;
    nodes_[i].is_behind = false;
    if (projection.exists &&
        ((pair_.overlap.is_allowed && projection.gap < 0.) || pair_.overlap.closes(projection.gap)))
      nodes_[i].initial_depth = -projection.gap;
    states_[i].gap = nodes_[i].gap_n = projection.gap - lift_of(nodes_[i]);
    nodes_[i].patch = projection.patch;
    if (!friction_n_.empty()) {
      friction_n_[i] = FrictionHistory();
      friction_n_[i].tool_position = on_tool;
    }
  }
  friction_ = friction_n_;
  remember_positions();
  for (auto &facet : facets_)
    facet.shallow_areas.fill(not_touching);
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

std::vector<double> EdgeContact::offsets() const {
  std::vector<double> numbers;
  RowWriter row(numbers);
  for (const auto &[pair, offset] : offsets_n_) {
    for (const auto &[key, side] : pair)
      row.number(static_cast<double>(key >> 32U))
          .number(static_cast<double>(key & half_key))
          .number(static_cast<double>(side));
    row.number(offset);
  }
  return numbers;
}

void EdgeContact::add_offsets(const std::vector<double> &numbers) {
  RowReader row(numbers.data());
  for (std::size_t i = 0; i < numbers.size(); i += 7) {
    PairId pair{};
    for (auto &[key, side] : pair) {
      const auto high = static_cast<std::uint64_t>(row.number());
      key = (high << 32U) | static_cast<std::uint64_t>(row.number());
      side = static_cast<std::uint64_t>(row.number());
    }
    offsets_n_[pair] = row.number();
  }
}

void FacetContact::save(StateWriter &writer) const {
  std::vector<std::uint64_t> keys;
  std::vector<double> touches, histories, lifts;
  RowWriter touch_row(touches), history_row(histories);
  const auto any = [this](const std::vector<double> &of_slaves) {
    return dealii::Utilities::MPI::max(of_slaves.empty() ? 0 : 1, communicator_) == 1;
  };
  const bool is_augmented = any(lifts_n_), has_depths = any(initial_depths_);
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
    if (is_augmented || has_depths)
      RowWriter(lifts).number(is_augmented ? lifts_n_[s] : 0.).number(has_depths ? initial_depths_[s] : 0.);
    if (history_n_.empty())
      continue;
    const SlaveHistory &history = history_n_[s];
    history_row.number(history.is_active ? 1. : 0.);
    store(history.frame, history_row);
    history_row.number(history.tangential[0]).number(history.tangential[1]);
    history_row.number(history.slip).number(history.slip_rate);
  }
  writer.write("start",
               {has_started_ ? 1. : 0., is_augmented ? 1. : 0., has_depths ? 1. : 0., allowed_part_});
  writer.write("stiffening", {stiffening_});
  writer.write_rows("touched", touch_width, keys, touches);
  if (edges_)
    write_list(writer, "edges", dealii::Utilities::MPI::this_mpi_process(communicator_), edges_->offsets());
  if (is_augmented || has_depths)
    writer.write_rows("lifts", 2, keys, lifts);
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
  if (edges_ && reader.has("edges"))
    for (unsigned int rank = 0; rank < reader.n_ranks(); ++rank)
      edges_->add_offsets(read_list(reader, "edges", rank));
  const std::vector<double> start = reader.read("start");
  const bool is_augmented = start.at(1) != 0., has_depths = start.at(2) != 0.;
  has_started_ = start.at(0) != 0.;
  has_lifts_ = is_augmented || has_depths;
  allowed_part_ = allowed_part_n_ = start.at(3);
  if (reader.has("stiffening"))
    stiffen(reader.number("stiffening") / stiffening_);
  lifts_n_.assign(is_augmented ? slaves_.size() : 0, 0.);
  initial_depths_.assign(has_depths ? slaves_.size() : 0, 0.);
  if (has_lifts_) {
    const std::vector<double> lifts = reader.read_rows("lifts", 2, keys, &is_known);
    for (std::size_t s = 0; s < slaves_.size(); ++s) {
      if (is_augmented)
        lifts_n_[s] = lifts[2 * s];
      if (has_depths)
        initial_depths_[s] = lifts[2 * s + 1];
    }
  }
  lifts_ = lifts_n_;
  if (std::holds_alternative<Frictionless>(settings_.friction) || !reader.has("friction"))
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
  base_ = history_ = history_n_;
}

std::vector<double> FacetContact::couplings() const {
  std::vector<double> numbers;
  RowWriter row(numbers);
  for (const auto &keys : coupled_) {
    row.number(static_cast<double>(keys.size()));
    for (const std::uint64_t key : keys)
      row.number(static_cast<double>(key >> 32U)).number(static_cast<double>(key & half_key));
  }
  return numbers;
}

void FacetContact::set_couplings(const std::vector<double> &numbers) {
  coupled_.assign(slaves_.size(), {});
  RowReader row(numbers.data());
  for (auto &keys : coupled_) {
    keys.resize(static_cast<std::size_t>(row.number()));
    for (std::uint64_t &key : keys) {
      const auto high = static_cast<std::uint64_t>(row.number());
      key = (high << 32U) | static_cast<std::uint64_t>(row.number());
    }
  }
}

} // namespace billet
