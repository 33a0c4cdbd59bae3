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

constexpr std::size_t pressed_width = 8;                  // of a node that may press
constexpr std::size_t pressed_slave_width = 6;            // of a slave of a body
constexpr std::size_t gap_width = 4, friction_width = 20; // of a node on a tool
constexpr std::size_t behind_width = 4;                   // of a node that may be behind a tool
constexpr std::size_t areas_width = 4;                    // of a facet

constexpr std::size_t touch_width = 9, slave_width = 18; // of a node on facets

// A facet's key has more bits than a double keeps.
constexpr std::uint64_t half_key = 0xffffffffU;

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
  // A tool that was another one, or another mesh's, may have had other points inside facets.
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
  // A law that is new begins without traction.
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
    history_row.number(history.slip).number(history.slip_rate).number(history.area);
  }
  writer.write("start",
               {has_started_ ? 1. : 0., is_augmented ? 1. : 0., has_depths ? 1. : 0., allowed_part_});
  writer.write("stiffening", {stiffening_, tangential_stiffening_});
  writer.write_rows("touched", touch_width, keys, touches);
  std::vector<double> pressed;
  for (const auto &slave : pressed_n_)
    RowWriter(pressed).number(slave.pressure).number(slave.depth).number(slave.area).vector(slave.normal);
  writer.write_rows("pressed", pressed_slave_width, keys, pressed);
  if (edges_)
    write_list(writer, "edges", dealii::Utilities::MPI::this_mpi_process(communicator_), edges_->offsets());
  if (is_augmented || has_depths)
    writer.write_rows("lifts", 2, keys, lifts);
  if (settings_.friction != nullptr)
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
  if (reader.has("pressed")) {
    const std::vector<double> pressed = reader.read_rows("pressed", pressed_slave_width, keys, &is_known);
    for (std::size_t s = 0; s < slaves_.size(); ++s) {
      RowReader row(&pressed[pressed_slave_width * s]);
      pressed_n_[s].pressure = row.number();
      pressed_n_[s].depth = row.number();
      pressed_n_[s].area = row.number();
      row.vector(pressed_n_[s].normal);
    }
  }
  const std::vector<double> start = reader.read("start");
  const bool is_augmented = start.at(1) != 0., has_depths = start.at(2) != 0.;
  has_started_ = start.at(0) != 0.;
  has_lifts_ = is_augmented || has_depths;
  allowed_part_ = allowed_part_n_ = start.at(3);
  if (reader.has("stiffening")) {
    const std::vector<double> factors = reader.read("stiffening");
    scale_penalties(factors.at(0) / stiffening_, factors.at(1) / tangential_stiffening_);
  }
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
  if (settings_.friction == nullptr || !reader.has("friction"))
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
    history.area = row.number();
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
