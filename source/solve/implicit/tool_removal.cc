// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/tool_removal.h"

#include "billet/solve/fading_names.h"
#include "billet/solve/tool_fade.h"

#include <algorithm>
#include <array>

namespace billet {

double ToolRemoval::fading(const double t, const std::size_t tool) const {
  return left_after_removal(scene_.tools()[tool], t);
}

bool ToolRemoval::changes(const double t_n, const double t) const {
  for (std::size_t tool = 0; tool < forces_.size(); ++tool)
    if (forces_[tool] && fading(t, tool) != fading(t_n, tool))
      return true;
  return false;
}

void ToolRemoval::add_forces(const double t, Vector &residual) const {
  visit_fading(t, [&](const RemovedForces &removed, const double left) {
    residual.add(-left, removed.forces.at_nodes());
  });
}

double ToolRemoval::work(const double t_n, const double t, const Vector &increment) const {
  double work = 0.;
  for (std::size_t tool = 0; tool < forces_.size(); ++tool)
    if (forces_[tool])
      work += 0.5 * (fading(t, tool) + fading(t_n, tool)) * (forces(tool) * increment);
  return work;
}

Vector ToolRemoval::forces(const std::size_t tool) const {
  Vector sum = discretization_.make_owned_vector();
  for (const RemovedForces &removed : *forces_[tool])
    sum -= removed.forces.at_nodes();
  return sum;
}

ToolRemoval::Removal ToolRemoval::remove_due(const double t) {
  Removal removal;
  for (std::size_t i = 0; i < scene_.tools().size(); ++i) {
    if (t < scene_.tools()[i].removal_time() || forces_[i])
      continue;
    forces_[i] = std::make_unique<std::vector<RemovedForces>>();
    for (auto &contact : contacts_.of_tools())
      if (contact.tool() == i) {
        if (contact.measures().compute_load().area > 0.)
          removal.let_go[contact.body()].insert(scene_.tools()[i].name());
        Vector residual = discretization_.make_additive_vector();
        contact.with_matrix().add_forces(residual);
        residual.compress(dealii::VectorOperation::add);
        contact.remove_tool();
        Vector forces = discretization_.make_owned_vector();
        forces = residual;
        forces *= -1.;
        forces_[i]->push_back({i, contact.group_index(), DeadForces(discretization_, forces)});
      }
    removal.tools.push_back(i);
  }
  return removal;
}

void ToolRemoval::save(const std::size_t tool, StateWriter &writer, const OwnedNodes &nodes) const {
  if (!forces_[tool])
    return;
  std::vector<std::optional<std::size_t>> pairs;
  for (const RemovedForces &removed : *forces_[tool])
    pairs.push_back(removed.pair);
  save_fading_pairs(writer, scene_, pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Vector &of_pair = (*forces_[tool])[i].forces.at_nodes();
    std::vector<std::uint64_t> keys;
    std::vector<double> forces;
    for (std::size_t n = 0; n < nodes.keys.size(); ++n) {
      const DofIndex dof = nodes.first_dofs[n];
      const std::array<double, 3> force{of_pair(dof), of_pair(dof + 1), of_pair(dof + 2)};
      if (force[0] == 0. && force[1] == 0. && force[2] == 0.)
        continue;
      keys.push_back(nodes.keys[n]);
      forces.insert(forces.end(), force.begin(), force.end());
    }
    save_parts(writer, fading_rows(i),
               dealii::Utilities::MPI::this_mpi_process(discretization_.communicator()), keys, forces);
  }
}

void ToolRemoval::load(const std::size_t tool, StateReader &reader, const OwnedNodes &nodes) {
  if (reader.read("flags", 2).at(1) == 0.)
    return;
  forces_[tool] = std::make_unique<std::vector<RemovedForces>>();
  for (const FadingPair &fading : load_fading_pairs(reader, scene_)) {
    const std::vector<double> rows = load_sums(reader, fading.rows, nodes.keys);
    Vector forces = discretization_.make_owned_vector();
    for (std::size_t n = 0; n < nodes.keys.size(); ++n)
      for (unsigned int c = 0; c < 3; ++c)
        forces(nodes.first_dofs[n] + c) = rows[3 * n + c];
    forces.compress(dealii::VectorOperation::insert);
    forces_[tool]->push_back({tool, fading.pair, DeadForces(discretization_, forces)});
  }
}

double ReleasedForces::left(const double t) const {
  if (!forces_ || t >= end_)
    return 0.;
  return 1. - (t - begin_) / (end_ - begin_);
}

void ReleasedForces::hold(const Vector &residual, const double t) {
  forces_ = std::make_unique<Vector>(residual);
  begin_ = t;
}

void ReleasedForces::add_forces(const double t, Vector &residual) const {
  if (forces_)
    residual.add(-left(t), *forces_);
}

double ReleasedForces::work(const double t_n, const double t, const Vector &increment) const {
  return forces_ ? 0.5 * (left(t) + left(t_n)) * (*forces_ * increment) : 0.;
}

void ReleasedForces::save(StateWriter &writer, const OwnedNodes &nodes) const {
  if (!forces_)
    return;
  writer.write("release", {begin_, end_, are_of_refinement_ ? 1. : 0.});
  save_nodal(writer, "imbalance", nodes, *forces_);
}

void ReleasedForces::load(StateReader &reader, const OwnedNodes &nodes,
                          const Discretization &discretization) {
  if (!reader.has("release"))
    return;
  forces_ = std::make_unique<Vector>(discretization.make_owned_vector());
  load_nodal(reader, "imbalance", nodes, *forces_);
  const std::vector<double> release = reader.read("release", 3);
  begin_ = release[0];
  end_ = release[1];
  are_of_refinement_ = release[2] != 0.;
}

} // namespace billet
