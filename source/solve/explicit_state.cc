// SPDX-License-Identifier: LGPL-2.1-or-later
// What an explicit scene gives to a checkpoint, and how it goes on from one.
#include "billet/solve/explicit_dynamics.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

namespace {

/// Of nodes for which this rank speaks.
std::vector<std::uint64_t> owned_keys(const LocalNodes &nodes, const NodeKeys &keys) {
  std::vector<std::uint64_t> result;
  for (unsigned int node = 0; node < nodes.size(); ++node)
    if (nodes.is_owned(node))
      result.push_back(keys(nodes.dofs(node)[0]));
  return result;
}

/// Of all nodes of this rank.
std::vector<std::uint64_t> all_keys(const LocalNodes &nodes, const NodeKeys &keys) {
  std::vector<std::uint64_t> result;
  for (unsigned int node = 0; node < nodes.size(); ++node)
    result.push_back(keys(nodes.dofs(node)[0]));
  return result;
}

template <class ValueOf>
void save_nodes(StateWriter &writer, const std::string &name, const LocalNodes &nodes,
                const std::vector<std::uint64_t> &keys, const ValueOf &value_of) {
  std::vector<double> rows;
  RowWriter row(rows);
  for (unsigned int node = 0; node < nodes.size(); ++node)
    if (nodes.is_owned(node))
      row.vector(value_of(node));
  writer.write_rows(name, 3, keys, rows);
}

void load_nodes(const StateReader &reader, const std::string &name, const std::vector<std::uint64_t> &keys,
                NodalVectors &values) {
  const std::vector<double> rows = reader.read_rows(name, 3, keys);
  for (std::size_t node = 0; node < keys.size(); ++node)
    for (unsigned int i = 0; i < 3; ++i)
      values[nodal_stride * node + i] = rows[3 * node + i];
}

} // namespace

void FreeTool::save(StateWriter &writer) const {
  writer.write("offset", {offset_before_, offset_ - offset_before_});
  writer.write("flags", {has_stopped_ ? 1. : 0., is_removed_ ? 1. : 0.});
  writer.write("placement", to_numbers(before_));
  writer.write("placement now", to_numbers(now_));
  writer.write("free", {offset_, offset_before_, rate_, rate_before_, load_});
  if (inertia_ > 0.)
    writer.write("rate", {0.5 * (rate_ + rate_before_)}); // at the placement
}

void FreeTool::load(const StateReader &reader, const bool is_exact) {
  const std::vector<double> flags = reader.read("flags");
  has_stopped_ = flags.at(0) != 0.;
  is_removed_ = flags.at(1) != 0.;
  offset_ = offset_before_ = reader.read("offset").at(0);
  before_ = now_ = to_placement(reader.read("placement"));
  if (is_removed_)
    rate_ = rate_before_ = 0.;
  else if (inertia_ > 0. && reader.has("rate"))
    rate_ = rate_before_ = reader.number("rate");
  if (!is_exact)
    return;
  now_ = to_placement(reader.read("placement now"));
  const std::vector<double> free = reader.read("free");
  offset_ = free.at(0);
  offset_before_ = free.at(1);
  rate_ = free.at(2);
  rate_before_ = free.at(3);
  load_ = free.at(4);
}

void ExplicitDynamics::save(StateWriter &writer) const {
  const MPI_Comm communicator = discretization_.communicator();
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator);
  const NodeKeys keys(discretization_);
  const auto owned = owned_keys(nodes_, keys);
  const auto vectors_of = [](const NodalVectors &values) {
    return [&values](const unsigned int node) { return get_vector(values.data(), node); };
  };
  writer.write_text("scheme", "explicit");
  writer.write("time", {time_});
  writer.write("clock", {static_cast<double>(n_steps_), static_cast<double>(n_planned_), step_, step_before_,
                         is_growing_ ? 1. : 0., event_, time_before_});
  save_nodes(writer, "displacements", nodes_, owned, vectors_of(u_));
  save_nodes(writer, "velocities after", nodes_, owned, vectors_of(v_));
  save_nodes(writer, "velocities before", nodes_, owned, vectors_of(v_before_));
  // Histories are those of the last forces; what another method goes on with has to be of the same time.
  writer.write("time before", {time_before_});
  save_nodes(writer, "displacements before", nodes_, owned, [&](const unsigned int node) {
    return get_vector(u_.data(), node) - step_ * get_vector(v_.data(), node);
  });
  save_nodes(writer, "velocities", nodes_, owned, [&](const unsigned int node) {
    return 0.5 * (get_vector(v_.data(), node) + get_vector(v_before_.data(), node));
  });

  double kinetic = 0.;
  for (unsigned int node = 0; node < nodes_.size(); ++node)
    if (nodes_.is_owned(node))
      kinetic += 0.5 * masses_[node] * (get_vector(v_.data(), node) * get_vector(v_before_.data(), node));
  kinetic = dealii::Utilities::MPI::sum(kinetic, communicator);
  for (const auto &tool : tools_)
    kinetic += tool.kinetic_energy();
  writer.write("kinetic energy", {kinetic});
  const std::vector<double> own{works_.external, works_.plastic,  works_.friction,
                                works_.viscous,  elastic_energy_, hourglass_energy_};
  std::vector<double> sums(own.size());
  dealii::Utilities::MPI::sum(own, communicator, sums);
  EnergyLedger energies = state_.energies;
  energies.kinetic = kinetic;
  energies.external = sums[0];
  energies.plastic = sums[1];
  energies.friction = sums[2];
  energies.viscous = sums[3];
  energies.elastic = sums[4];
  energies.hourglass = sums[5];
  writer.write("energies", to_numbers(energies));
  writer.write("largest energy", {largest_energy_});
  writer.write("energy of steps", {energy_of_steps_});
  soft_penalties_.save(writer);
  penalties_.save(writer);
  writer.write_rows("works", 4, {rank}, {own.begin(), own.begin() + 4});

  for (std::size_t b = 0; b < blocks_.size(); ++b)
    writer.in(group("body", b), [&] {
      const ExplicitBlock &block = *blocks_[b];
      writer.write_text("formulation",
                        describe(make_formulation(scene_.parameters(), scene_.parameters().bodies[b]),
                                 *scene_.bodies()[b].law));
      const std::size_t width = block.history_size();
      std::vector<double> rows(width * block.size());
      for (std::size_t e = 0; e < block.size(); ++e)
        block.get_state(e, rows.data() + width * e);
      writer.write_rows("history", width, element_keys(discretization_, b), rows);
    });
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const ContactLoad load = sum_over_ranks(tool_loads_[i], communicator);
    writer.in(group("tool", i), [&] {
      writer.write_text("name", scene_.tools()[i].name());
      tools_[i].save(writer);
      writer.write("load", to_numbers(load));
      if (!fading_forces_[i])
        return;
      std::vector<std::uint64_t> fading_keys;
      std::vector<double> forces;
      for (const unsigned int node : loaded_nodes_) {
        const Tensor<1, 3> force = get_vector(fading_forces_[i]->data(), node);
        if (force.norm_square() == 0.)
          continue;
        fading_keys.push_back(keys(nodes_.dofs(node)[0]));
        RowWriter(forces).vector(force);
      }
      save_parts(writer, "fading", rank, fading_keys, forces);
    });
  }
  for (const auto &contact : contacts_)
    writer.in(group(contact.group_kind(), contact.group_index()), [&] {
      save_pair(writer, contact);
      contact.save(writer, keys);
    });
}

RestartReport ExplicitDynamics::load(StateReader &reader) {
  const NodeKeys keys(discretization_);
  RestartReport report;
  report.is_exact = reader.read_text("scheme") == "explicit";
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    reader.in(group("body", b), [&] {
      const auto &input = scene_.parameters().bodies[b];
      report.is_exact = report.is_exact &&
                        reader.read_text("formulation") ==
                            describe(make_formulation(scene_.parameters(), input), *scene_.bodies()[b].law);
    });
  const bool is_exact = report.is_exact; // other tools or pairs change nothing in how the rest goes on
  compare_parts(reader, scene_, report);

  load_nodal_state(reader, keys, is_exact);
  if (is_exact)
    load_clock(reader);
  else
    time_ = reader.number(reader.has("time before") ? "time before" : "time");
  load_tools(reader, keys, is_exact);
  load_contacts(reader, keys);

  // What the ledger has so far; the rest follows from the state.
  state_.energies = to_energies(reader.read("energies"));
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(discretization_.communicator());
  const bool is_same_partition =
      is_exact && reader.n_ranks() == dealii::Utilities::MPI::n_mpi_processes(discretization_.communicator());
  if (is_same_partition) {
    const std::vector<double> works = reader.read_rows("works", 4, {rank});
    works_ = {works[0], works[1], works[2], works[3]};
  } else if (rank == 0) {
    const EnergyLedger &e = state_.energies;
    works_ = {e.external, e.plastic, e.friction, e.viscous};
  }
  if (is_exact) {
    largest_energy_ = reader.number("largest energy");
    energy_of_steps_ = reader.number("energy of steps");
    soft_penalties_.load(reader);
    penalties_.load(reader);
  }
  report.time = time_;
  return report;
}

void ExplicitDynamics::load_nodal_state(StateReader &reader, const NodeKeys &keys, const bool is_exact) {
  const auto all = all_keys(nodes_, keys);
  if (is_exact) {
    load_nodes(reader, "displacements", all, u_);
    load_nodes(reader, "velocities after", all, v_);
    load_nodes(reader, "velocities before", all, v_before_);
    for (std::size_t b = 0; b < blocks_.size(); ++b)
      reader.in(group("body", b), [&] {
        const std::size_t width = blocks_[b]->history_size();
        const auto rows = reader.read_rows("history", width, element_keys(discretization_, b));
        for (std::size_t e = 0; e < blocks_[b]->size(); ++e)
          blocks_[b]->set_state(e, rows.data() + width * e);
      });
    return;
  }
  load_nodes(reader, reader.has("displacements before") ? "displacements before" : "displacements", all, u_);
  if (reader.has("velocities"))
    load_nodes(reader, "velocities", all, v_);
  nodes_.copy(u_, state_.displacements);
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    reader.in(group("body", b), [&] {
      const auto stresses = load_stress(reader, scene_, b, discretization_, state_.displacements);
      for (std::size_t e = 0; e < blocks_[b]->size(); ++e)
        blocks_[b]->set_stress(e, u_.data(), stresses[e]);
    });
}

void ExplicitDynamics::load_clock(StateReader &reader) {
  time_ = reader.number("time");
  const std::vector<double> clock = reader.read("clock");
  n_steps_ = static_cast<unsigned int>(clock.at(0));
  n_planned_ = static_cast<unsigned int>(clock.at(1));
  step_ = clock.at(2);
  step_before_ = clock.at(3);
  is_growing_ = clock.at(4) != 0.;
  event_ = clock.at(5);
  time_before_ = clock.at(6);
}

void ExplicitDynamics::load_tools(StateReader &reader, const NodeKeys &keys, const bool is_exact) {
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(discretization_.communicator());
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(discretization_.communicator());
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const auto found = find_group(reader, "tool", scene_.tools()[i].name());
    if (!found) {
      tools_[i].begin(time_);
      continue;
    }
    reader.in(group("tool", *found), [&] {
      tools_[i].load(reader, is_exact);
      if (!reader.has("fading"))
        return;
      fading_forces_[i] = std::make_unique<NodalVectors>(nodes_.make_vectors());
      const auto all = all_keys(nodes_, keys);
      const bool is_same_partition = is_exact && reader.n_ranks() == n_ranks;
      const std::vector<double> forces =
          is_same_partition ? load_part(reader, "fading", rank, all) : load_sums(reader, "fading", all);
      for (unsigned int node = 0; node < nodes_.size(); ++node)
        if (is_same_partition || nodes_.is_owned(node))
          for (unsigned int c = 0; c < 3; ++c)
            (*fading_forces_[i])[std::size_t{nodal_stride} * node + c] = forces[std::size_t{3} * node + c];
    });
  }
}

void ExplicitDynamics::load_contacts(StateReader &reader, const NodeKeys &keys) {
  // Contact was committed with the forces at the time before. `step_` is 0 where that is now.
  NodalVectors u_before = u_;
  for (std::size_t k = 0; k < u_.size(); ++k)
    u_before[k] -= step_ * v_[k];
  const std::vector<Placement> placements = placements_of(&FreeTool::before);
  for (auto &contact : contacts_)
    if (!load_pair(reader, contact, [&] { contact.load(reader, keys); }))
      contact.begin({0., 0., 0., placements, placements}, u_before);
}

void ExplicitDynamics::plan_to(const double event) {
  if (event_ != event)
    n_planned_ = 0;
}

} // namespace billet
