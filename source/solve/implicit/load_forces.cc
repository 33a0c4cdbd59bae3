// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/load_forces.h"

#include "billet/fail_together.h"
#include "billet/forces/surface_coupling.h"

#include <algorithm>

namespace billet {

LoadForces::LoadForces(const Scene &scene, const Discretization &discretization, const LocalNodes &nodes,
                       const std::function<std::vector<double>(const LocalNodes &)> &masses)
    : discretization_(discretization), nodes_(nodes), forces_n_(discretization.make_owned_vector()),
      forces_(forces_n_) {
  if (std::any_of(scene.bodies().begin(), scene.bodies().end(),
                  [](const Body &body) { return !body.loads.empty(); })) {
    check_surface_couplings(scene, discretization);
    loads_ = std::make_unique<Loads>(scene, nodes, masses(nodes));
  }
}

NodalVectors LoadForces::nodal(const Vector &field) const {
  NodalVectors result = nodes_.make_vectors();
  Vector values = discretization_.make_ghosted_vector();
  values = field;
  for (unsigned int node = 0; node < nodes_.size(); ++node)
    for (unsigned int i = 0; i < 3; ++i)
      result[std::size_t{nodal_stride} * node + i] = values(nodes_.dofs(node)[i]);
  return result;
}

Vector LoadForces::sum_of(const NodalVectors &forces) const {
  Vector sum = discretization_.make_additive_vector();
  for (unsigned int node = 0; node < nodes_.size(); ++node)
    sum.add(3, nodes_.dofs(node).data(), &forces[std::size_t{nodal_stride} * node]);
  sum.compress(dealii::VectorOperation::add);
  Vector owned = discretization_.make_owned_vector();
  owned = sum;
  return owned;
}

double LoadForces::subtract(const double t, const Vector &displacements, const Vector &velocities,
                            Vector &residual) {
  if (loads_ == nullptr)
    return 0.;
  loads_->time = t;
  displaced_ = nodal(displacements);
  rates_ = nodal(velocities);
  loads_->all.follow(displaced_);
  NodalVectors forces = nodes_.make_vectors();
  fail_together(discretization_.communicator(),
                [&] { loads_->all.add_forces(t, displaced_, rates_, forces); });
  forces_ = sum_of(forces);
  residual -= forces_;
  return forces_.l2_norm();
}

void LoadForces::add_tangent(const double t, const double damping_factor, const TangentSystem &system) const {
  if (loads_ != nullptr)
    loads_->all.add_tangent(t, displaced_, rates_, damping_factor, system);
}

void LoadForces::start() {
  forces_n_ = forces_;
  if (displaced_.empty())
    return;
  NodalVectors sum = nodes_.make_vectors();
  loads_->works.evaluate(loads_->time, displaced_, rates_, sum);
}

Vector LoadForces::start_after(const double t, const Vector &velocities) {
  Vector change = discretization_.make_owned_vector();
  if (loads_ == nullptr || displaced_.empty())
    return change;
  rates_ = nodal(velocities);
  NodalVectors sum = nodes_.make_vectors();
  fail_together(discretization_.communicator(),
                [&] { loads_->works.evaluate_after(t, displaced_, rates_, sum); });
  change -= forces_;
  forces_ = sum_of(sum);
  forces_n_ = forces_;
  change += forces_;
  return change;
}

double LoadForces::commit(const Vector &increment) {
  if (loads_ == nullptr)
    return 0.;
  forces_n_ += forces_;
  const double work = 0.5 * (forces_n_ * increment);
  const NodalVectors moved = nodal(increment);
  loads_->works.add_works(moved, 0.5);
  start();
  loads_->works.add_works(moved, 0.5);
  return work;
}

std::vector<LoadResult> LoadForces::results() const {
  return loads_ != nullptr ? loads_->works.results() : std::vector<LoadResult>();
}

void LoadForces::save(StateWriter &writer, const OwnedNodes &nodes) const {
  save_nodal(writer, "load forces", nodes, forces_n_);
  if (loads_ == nullptr)
    return;
  loads_->works.save(writer);
  loads_->works.save_forces(writer, nodes);
}

void LoadForces::load(const StateReader &reader, const OwnedNodes &nodes) {
  load_nodal(reader, "load forces", nodes, forces_n_);
  if (loads_ == nullptr)
    return;
  loads_->works.load(reader);
  loads_->works.load_forces(reader, nodes);
}

} // namespace billet
