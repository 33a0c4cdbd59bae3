// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/support_reactions.h"

#include "billet/discretization/support_parts.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

namespace {

/// Returns the indices in named_supports() of the constraints of a body; `first` is that of its first one.
std::vector<std::size_t> support_indices(const Body &body, const std::size_t first) {
  std::vector<std::size_t> indices;
  std::vector<std::string> names;
  for (const Constraint &constraint : body.constraints) {
    const auto found = std::find(names.begin(), names.end(), constraint.name);
    indices.push_back(first + static_cast<std::size_t>(found - names.begin()));
    if (found == names.end())
      names.push_back(constraint.name);
  }
  return indices;
}

/// Returns the vector d in the space of these independent normals with d · n = 1 for the one at `index` and 0
/// for all others.
Tensor<1, 3> dual_vector(const std::vector<Tensor<1, 3>> &normals, const std::size_t index) {
  std::vector<Tensor<1, 3>> others;
  const auto remove_others = [&others](Tensor<1, 3> v) {
    for (const auto &e : others)
      v -= (v * e) * e;
    return v;
  };
  for (std::size_t i = 0; i < normals.size(); ++i)
    if (i != index) {
      const Tensor<1, 3> left = remove_others(normals[i]);
      others.push_back(left / left.norm());
    }
  const Tensor<1, 3> d = remove_others(normals[index]);
  return d / (d * normals[index]);
}

/// Returns which of the normals are independent of those before them.
std::vector<std::size_t> find_independent(const std::vector<const Constraint *> &constraints,
                                          const dealii::Point<3> &position) {
  constexpr double independent = 1e-8; // as in collect_fixed_nodes()
  std::vector<std::size_t> indices;
  std::vector<Tensor<1, 3>> basis;
  for (std::size_t h = 0; h < constraints.size(); ++h) {
    Tensor<1, 3> left = constraints[h]->direction(position);
    for (const auto &e : basis)
      left -= (left * e) * e;
    if (left.norm() <= independent)
      continue;
    basis.push_back(left / left.norm());
    indices.push_back(h);
  }
  return indices;
}

} // namespace

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
    : scene_(scene), discretization_(discretization), n_supports_(named_supports(scene).size()) {
  std::size_t first = 0;
  for (const Body &body : scene.bodies()) {
    const std::vector<std::size_t> indices = support_indices(body, first);
    for (std::size_t h = 0; h < indices.size(); ++h) {
      support_of_[&body.constraints[h]] = indices[h];
      first = std::max(first, indices[h] + 1);
    }
  }
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
  const auto acts = [&acting](const Constraint &constraint) { return acting(constraint); };
  for (const auto &[dof, held] : collect_constrained_nodes(scene_, discretization_, acts)) {
    if (!discretization_.owned_dofs().is_element(dof))
      continue;
    Node node{held.dofs, held.position, {}};
    const std::vector<std::size_t> independent = find_independent(held.constraints, held.position);
    std::vector<Tensor<1, 3>> normals;
    for (const std::size_t h : independent)
      normals.push_back(held.constraints[h]->direction(held.position));
    for (std::size_t i = 0; i < normals.size(); ++i)
      node.parts.push_back(
          {support_of_.at(held.constraints[independent[i]]), normals[i], dual_vector(normals, i)});
    nodes_.push_back(node);
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
