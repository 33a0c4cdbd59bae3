// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/tool_removal.h"

#include <algorithm>
#include <array>

namespace billet {

double ToolRemoval::fading(const double t, const std::size_t tool) const {
  const Tool &gone = scene_.tools()[tool];
  return gone.release_time() > 0. ? std::max(0., 1. - (t - gone.removal_time()) / gone.release_time()) : 0.;
}

bool ToolRemoval::changes(const double t_n, const double t) const {
  for (std::size_t tool = 0; tool < forces_.size(); ++tool)
    if (forces_[tool] && fading(t, tool) != fading(t_n, tool))
      return true;
  return false;
}

void ToolRemoval::add_forces(const double t, Vector &residual) const {
  for (std::size_t tool = 0; tool < forces_.size(); ++tool)
    if (forces_[tool])
      residual.add(fading(t, tool), *forces_[tool]);
}

double ToolRemoval::work(const double t_n, const double t, const Vector &increment) const {
  double work = 0.;
  for (std::size_t tool = 0; tool < forces_.size(); ++tool)
    if (forces_[tool])
      work += 0.5 * (fading(t, tool) + fading(t_n, tool)) * (*forces_[tool] * increment);
  return work;
}

ToolRemoval::Removal ToolRemoval::remove_due(const double t) {
  Removal removal;
  for (std::size_t i = 0; i < scene_.tools().size(); ++i) {
    if (t < scene_.tools()[i].removal_time() || forces_[i])
      continue;
    Vector forces = discretization_.make_additive_vector();
    for (auto &contact : contacts_.of_tools())
      if (contact.tool() == i) {
        if (contact.measures().compute_load().area > 0.)
          removal.let_go[contact.body()].insert(scene_.tools()[i].name());
        contact.with_matrix().add_forces(forces);
        contact.remove_tool();
      }
    forces.compress(dealii::VectorOperation::add);
    forces_[i] = std::make_unique<Vector>(discretization_.make_owned_vector());
    *forces_[i] = forces;
    removal.tools.push_back(i);
  }
  return removal;
}

void ToolRemoval::save(const std::size_t tool, StateWriter &writer, const OwnedNodes &nodes) const {
  if (!forces_[tool])
    return;
  // The force on the nodes is the residual with opposite sign.
  std::vector<std::uint64_t> keys;
  std::vector<double> forces;
  for (std::size_t n = 0; n < nodes.keys.size(); ++n) {
    const DofIndex dof = nodes.first_dofs[n];
    const std::array<double, 3> force{-(*forces_[tool])(dof), -(*forces_[tool])(dof + 1),
                                      -(*forces_[tool])(dof + 2)};
    if (force[0] == 0. && force[1] == 0. && force[2] == 0.)
      continue;
    keys.push_back(nodes.keys[n]);
    forces.insert(forces.end(), force.begin(), force.end());
  }
  save_parts(writer, "fading", dealii::Utilities::MPI::this_mpi_process(discretization_.communicator()), keys,
             forces);
}

void ToolRemoval::load(const std::size_t tool, StateReader &reader, const OwnedNodes &nodes) {
  if (reader.read("flags", 2).at(1) == 0.)
    return;
  const std::vector<double> forces = load_sums(reader, "fading", nodes.keys);
  forces_[tool] = std::make_unique<Vector>(discretization_.make_owned_vector());
  for (std::size_t n = 0; n < nodes.keys.size(); ++n)
    for (unsigned int c = 0; c < 3; ++c)
      (*forces_[tool])(nodes.first_dofs[n] + c) = -forces[3 * n + c];
  forces_[tool]->compress(dealii::VectorOperation::insert);
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
