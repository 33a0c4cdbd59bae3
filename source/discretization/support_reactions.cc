// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/support_reactions.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

void sum_over_ranks(std::vector<Resultant> &resultants, const MPI_Comm communicator) {
  std::vector<double> values;
  for (const Resultant &resultant : resultants)
    for (const Tensor<1, 3> &vector : {resultant.force, resultant.moment})
      for (unsigned int i = 0; i < 3; ++i)
        values.push_back(vector[i]);
  dealii::Utilities::MPI::sum(values, communicator, values);
  auto next = values.begin();
  for (Resultant &resultant : resultants)
    for (Tensor<1, 3> *vector : {&resultant.force, &resultant.moment})
      for (unsigned int i = 0; i < 3; ++i)
        (*vector)[i] = *next++;
}

std::vector<NamedSupport> named_supports(const Scene &scene) {
  std::vector<NamedSupport> all;
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    const Body &body = scene.bodies()[b];
    const std::size_t first = all.size();
    const std::vector<std::size_t> indices = support_indices(body, first);
    for (std::size_t h = 0; h < indices.size(); ++h)
      if (indices[h] == all.size())
        all.push_back({b, body.constraints[h].name});
  }
  return all;
}

SupportReactions::SupportReactions(const Scene &scene, const Discretization &discretization,
                                   const ActingConstraints &acting)
    : scene_(scene), discretization_(discretization), support_of_(support_indices(scene)),
      n_supports_(named_supports(scene).size()) {
  collect_nodes(acting);
  const std::vector<ConstraintLine> links =
      collect_links(discretization.dof_handler(), discretization.relevant_dofs());
  links_ = build_constraints(discretization.owned_dofs(), discretization.relevant_dofs(), {{links, {}}});
  couples_ranks_ = couple_ranks(links_, discretization.owned_dofs(), discretization.communicator());
}

void SupportReactions::follow(const ActingConstraints &acting) {
  if (acting.n_changes() != n_changes_)
    collect_nodes(acting);
}

void SupportReactions::collect_nodes(const ActingConstraints &acting) {
  nodes_.clear();
  n_changes_ = acting.n_changes();
  for (const SupportedNode &node : collect_supported_nodes(scene_, discretization_, acting, support_of_))
    if (discretization_.owned_dofs().is_element(node.dofs[0]))
      nodes_.push_back(node);
}

void SupportReactions::add(const SupportedNode &node, const Tensor<1, 3> &displacement,
                           const Tensor<1, 3> &residual, Forces &sums) {
  const Tensor<1, 3> x = node.position + displacement;
  for (const SupportPart &part : node.parts) {
    const Tensor<1, 3> force = part.force(residual);
    sums.of_supports[part.support].force += force;
    sums.of_supports[part.support].moment += dealii::cross_product_3d(x, force);
    sums.free -= force;
  }
}

SupportReactions::Forces SupportReactions::sum_over_ranks(Forces own) const {
  own.of_supports.push_back({own.free, {}});
  billet::sum_over_ranks(own.of_supports, discretization_.communicator());
  own.free = own.of_supports.back().force;
  own.of_supports.pop_back();
  return own;
}

SupportReactions::Forces SupportReactions::compute(Vector residual, const Vector &displacements) const {
  condense(links_, couples_ranks_, residual);
  Forces own;
  own.of_supports.resize(n_supports_);
  const auto values = owned_values(std::as_const(residual)), u = owned_values(displacements);
  for (std::size_t k = 0; k < values.size(); k += 3) // owned dofs come node by node
    for (unsigned int i = 0; i < 3; ++i)
      own.free[i] += values[k + i];
  const auto &owned = discretization_.owned_dofs();
  for (const SupportedNode &node : nodes_) {
    Tensor<1, 3> force, displacement;
    for (unsigned int i = 0; i < 3; ++i) {
      const std::size_t place = owned.index_within_set(node.dofs[i]);
      force[i] = values[place];
      displacement[i] = u[place];
    }
    add(node, displacement, force, own);
  }
  return sum_over_ranks(std::move(own));
}

SupportReactions::Forces SupportReactions::compute(const LocalNodes &nodes, const NodalVectors &forces,
                                                   const NodalVectors &displacements) const {
  Forces own;
  own.of_supports.resize(n_supports_);
  for (const SupportedNode &held : nodes_) {
    const unsigned int node = nodes.find(held.dofs[0]);
    const Tensor<1, 3> force = get_vector(forces.data(), node);
    own.free += force;
    add(held, get_vector(displacements.data(), node), force, own);
  }
  return sum_over_ranks(std::move(own));
}

} // namespace billet
