// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/support_reactions.h"

#include "billet/discretization/support_parts.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

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
  for (const SupportedNode &held : collect_supported_nodes(scene_, discretization_, acting, support_of_)) {
    if (!discretization_.owned_dofs().is_element(held.dofs[0]))
      continue;
    nodes_.push_back({held.dofs, held.position, {}});
    for (const SupportPart &part : held.parts)
      nodes_.back().parts.push_back({part.support, part.normal, part.dual});
  }
}

void SupportReactions::add(const Node &node, const Tensor<1, 3> &displacement, const Tensor<1, 3> &residual,
                           Forces &sums) {
  const Tensor<1, 3> x = node.position + displacement;
  for (const Part &part : node.parts) {
    const Tensor<1, 3> force = (part.dual * residual) * part.normal;
    sums.of_supports[part.support].force += force;
    sums.of_supports[part.support].moment += dealii::cross_product_3d(x, force);
    sums.free -= force;
  }
}

SupportReactions::Forces SupportReactions::sum_over_ranks(const Forces &own) const {
  std::vector<double> values;
  const auto write = [&values](const Tensor<1, 3> &vector) {
    for (unsigned int i = 0; i < 3; ++i)
      values.push_back(vector[i]);
  };
  write(own.free);
  for (const Resultant &resultant : own.of_supports) {
    write(resultant.force);
    write(resultant.moment);
  }
  dealii::Utilities::MPI::sum(values, discretization_.communicator(), values);
  auto next = values.begin();
  const auto read = [&next](Tensor<1, 3> &vector) {
    for (unsigned int i = 0; i < 3; ++i)
      vector[i] = *next++;
  };
  Forces all;
  read(all.free);
  all.of_supports.resize(own.of_supports.size());
  for (Resultant &resultant : all.of_supports) {
    read(resultant.force);
    read(resultant.moment);
  }
  return all;
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
  for (const Node &node : nodes_) {
    Tensor<1, 3> force, displacement;
    for (unsigned int i = 0; i < 3; ++i) {
      const std::size_t place = owned.index_within_set(node.dofs[i]);
      force[i] = values[place];
      displacement[i] = u[place];
    }
    add(node, displacement, force, own);
  }
  return sum_over_ranks(own);
}

SupportReactions::Forces SupportReactions::compute(const LocalNodes &nodes, const NodalVectors &forces,
                                                   const NodalVectors &displacements) const {
  Forces own;
  own.of_supports.resize(n_supports_);
  for (const Node &held : nodes_) {
    const unsigned int node = nodes.find(held.dofs[0]);
    const Tensor<1, 3> force = get_vector(forces.data(), node);
    own.free += force;
    add(held, get_vector(displacements.data(), node), force, own);
  }
  return sum_over_ranks(own);
}

} // namespace billet
