// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/explicit_tools.h"

#include "billet/solve/fading_names.h"
#include "billet/solve/tool_fade.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

ExplicitTools::ExplicitTools(const Scene &scene, const LocalNodes &nodes) : scene_(scene), nodes_(nodes) {
  for (std::size_t i = 0; i < scene.tools().size(); ++i)
    tools_.emplace_back(scene.tools()[i], scene.parameters().tools[i].motion);
  has_free_tools_ = std::any_of(tools_.begin(), tools_.end(),
                                [](const FreeTool &tool) { return tool.inverse_inertia() > 0.; });
  memory_.set(static_cast<std::size_t>(std::count_if(
                  tools_.begin(), tools_.end(), [](const FreeTool &tool) { return tool.wants_load(); })) *
              sizeof(FreeTool));
  loads_.resize(tools_.size());
  pair_loads_.resize(scene.pairs().size());
  fading_forces_.resize(tools_.size());
}

bool ExplicitTools::move_within(const double time) const {
  return std::any_of(tools_.begin(), tools_.end(), [time](const FreeTool &tool) { return tool.moves(time); });
}

std::vector<Placement> ExplicitTools::placements(const Placement &(FreeTool::*get)() const) const {
  std::vector<Placement> placements;
  for (const FreeTool &tool : tools_)
    placements.push_back((tool.*get)());
  return placements;
}

void ExplicitTools::clear_loads() {
  std::fill(loads_.begin(), loads_.end(), ContactLoad());
  std::fill(pair_loads_.begin(), pair_loads_.end(), ContactLoad());
  stiffness_.assign(tools_.size(), 0.);
}

void ExplicitTools::add_load(const ContactInterface &contact, const std::size_t tool,
                             const ContactLoad &load) {
  loads_[tool] += load;
  pair_loads_[contact.group_index()] = load;
  if (tools_[tool].inverse_inertia() > 0.)
    stiffness_[tool] += contact.without_matrix().stiffness_against_tool();
}

double ExplicitTools::max_frequency_square() const {
  if (!has_free_tools_)
    return 0.;
  // Springs k_i are between nodes that move by u_i along a_i and a tool that moves by s. They hold
  //   k_i (u_i − s)² <= k_i (1/m_i + Σ_j k_j/(k_i M)) (m_i u_i² + k_i/(Σ_j k_j) M s²).
  // Thus ω² <= max k_i/m_i + Σ_j k_j/M. The second term is the tool's share, with a_i·a_i in k_i of
  // the tool.
  std::vector<double> sums(stiffness_.size());
  dealii::Utilities::MPI::sum(stiffness_, communicator(), sums);
  double share = 0.;
  for (std::size_t i = 0; i < tools_.size(); ++i)
    share = std::max(share, tools_[i].inverse_inertia() * sums[i]);
  return share;
}

void ExplicitTools::remove(const std::size_t tool, Contacts &contacts, double &external_work) {
  fading_forces_[tool] = std::make_unique<std::vector<Removed>>();
  NodalVectors ignored = nodes_.make_vectors();
  for (auto &contact : contacts.of_tools())
    if (contact.tool() == tool) {
      fading_forces_[tool]->push_back({contact.group_index(), nodes_.make_vectors()});
      contact.without_matrix().add_forces(fading_forces_[tool]->back().forces, ignored);
      contact.remove_tool();
    }
  // The energy of its penalty springs is removed with it, and its kinetic energy, which all ranks
  // know.
  external_work -= loads_[tool].stored_energy;
  if (dealii::Utilities::MPI::this_mpi_process(communicator()) == 0)
    external_work -= tools_[tool].kinetic_energy();
  tools_[tool].remove();
}

void ExplicitTools::remove_due(const double t, Contacts &contacts, double &external_work) {
  for (std::size_t i = 0; i < tools_.size(); ++i)
    if (tools_[i].is_gone(t) && !fading_forces_[i])
      remove(i, contacts, external_work);
}

void ExplicitTools::add_fading(const double t, const std::vector<unsigned int> &nodes,
                               NodalVectors &forces) const {
  for (std::size_t i = 0; i < tools_.size(); ++i)
    if (const double left = left_after_removal(scene_.tools()[i], t); is_fading(i, t))
      for (const Removed &removed : *fading_forces_[i])
        for (const unsigned int node : nodes)
          add_vector(forces.data(), node, left * get_vector(removed.forces.data(), node));
}

bool ExplicitTools::is_fading(const std::size_t tool, const double t) const {
  return fading_forces_[tool] && left_after_removal(scene_.tools()[tool], t) > 0.;
}

ContactLoad ExplicitTools::fading_load(const std::size_t tool, const double t,
                                       const NodalVectors &displacements,
                                       const std::optional<std::size_t> pair) const {
  ContactLoad load;
  if (!is_fading(tool, t))
    return load;
  const double left = left_after_removal(scene_.tools()[tool], t);
  const Tensor<1, 3> centre = tools_[tool].now().moved_centre();
  for (const Removed &removed : *fading_forces_[tool])
    if (!pair || removed.pair == pair)
      for (unsigned int node = 0; node < nodes_.size(); ++node) {
        const Tensor<1, 3> force = left * get_vector(removed.forces.data(), node);
        const Tensor<1, 3> x =
            get_vector(nodes_.positions().data(), node) + get_vector(displacements.data(), node);
        load.force += force;
        load.moment += dealii::cross_product_3d(x - centre, force);
      }
  return load;
}

void ExplicitTools::kick(const ExplicitClock &clock) {
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const ContactLoad load =
        tools_[i].wants_load() ? sum_over_ranks(loads_[i], communicator()) : ContactLoad();
    Usage::count_if(tools_[i].wants_load(), Capability::driven_tools, 1);
    tools_[i].kick(clock.time(), load, clock.step_before(), clock.step(), clock.is_at_start());
  }
}

void ExplicitTools::move(const ExplicitClock &clock) {
  for (auto &tool : tools_)
    tool.move(clock.time(), clock.step());
}

void ExplicitTools::add_works(const double t, double &external_work) const {
  const bool is_first_rank = dealii::Utilities::MPI::this_mpi_process(communicator()) == 0;
  for (std::size_t i = 0; i < tools_.size(); ++i)
    if (!tools_[i].is_gone(t))
      external_work += tools_[i].motion_work(loads_[i]) + (is_first_rank ? tools_[i].load_work() : 0.);
}

void ExplicitTools::save_fading(StateWriter &writer, const std::size_t tool, const NodalRows &rows,
                                const std::vector<unsigned int> &nodes) const {
  std::vector<std::optional<std::size_t>> pairs;
  for (const Removed &removed : *fading_forces_[tool])
    pairs.push_back(removed.pair);
  save_fading_pairs(writer, scene_, pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    std::vector<std::uint64_t> keys;
    std::vector<double> forces;
    for (const unsigned int node : nodes) {
      const Tensor<1, 3> force = get_vector((*fading_forces_[tool])[i].forces.data(), node);
      if (force.norm_square() == 0.)
        continue;
      keys.push_back(rows.of_nodes()[node]);
      RowWriter(forces).vector(force);
    }
    save_parts(writer, fading_rows(i), dealii::Utilities::MPI::this_mpi_process(communicator()), keys,
               forces);
  }
}

void ExplicitTools::load_fading(const StateReader &reader, const std::size_t tool, const NodalRows &rows,
                                const bool is_exact) {
  const bool is_same_partition =
      is_exact && reader.n_ranks() == dealii::Utilities::MPI::n_mpi_processes(communicator());
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator());
  fading_forces_[tool] = std::make_unique<std::vector<Removed>>();
  for (const FadingPair &fading : load_fading_pairs(reader, scene_)) {
    const std::vector<double> forces = is_same_partition
                                           ? load_part(reader, fading.rows, rank, rows.of_nodes())
                                           : load_sums(reader, fading.rows, rows.of_nodes());
    NodalVectors of_pair = nodes_.make_vectors();
    for (unsigned int node = 0; node < nodes_.size(); ++node)
      if (is_same_partition || nodes_.is_owned(node))
        for (unsigned int c = 0; c < 3; ++c)
          of_pair[std::size_t{nodal_stride} * node + c] = forces[std::size_t{3} * node + c];
    fading_forces_[tool]->push_back({fading.pair, of_pair});
  }
}

void ExplicitTools::save(StateWriter &writer, const NodalRows &rows,
                         const std::vector<unsigned int> &nodes) const {
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const ContactLoad load = sum_over_ranks(loads_[i], communicator());
    writer.in(group("tool", i), [&] {
      writer.write_text("name", scene_.tools()[i].name());
      tools_[i].save(writer);
      writer.write("load", to_numbers(load));
      if (fading_forces_[i])
        save_fading(writer, i, rows, nodes);
    });
  }
}

void ExplicitTools::load(StateReader &reader, const NodalRows &rows, const bool is_exact, const double t) {
  for (std::size_t i = 0; i < tools_.size(); ++i) {
    const auto found = find_group(reader, "tool", scene_.tools()[i].name());
    if (!found) {
      tools_[i].begin(t);
      continue;
    }
    reader.in(group("tool", *found), [&] {
      tools_[i].load(reader, is_exact);
      if (tools_[i].is_removed())
        load_fading(reader, i, rows, is_exact);
    });
  }
}

} // namespace billet
