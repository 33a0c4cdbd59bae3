// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/support_parts.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

namespace {

/// Returns the vector d in the space of these independent normals with d · n = 1 for the one at
/// `index` and 0 for all others.
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

std::map<const Constraint *, std::size_t> support_indices(const Scene &scene) {
  std::map<const Constraint *, std::size_t> all;
  std::size_t first = 0;
  for (const Body &body : scene.bodies()) {
    const std::vector<std::size_t> indices = support_indices(body, first);
    for (std::size_t h = 0; h < indices.size(); ++h) {
      all[&body.constraints[h]] = indices[h];
      first = std::max(first, indices[h] + 1);
    }
  }
  return all;
}

std::vector<SupportedNode>
collect_supported_nodes(const Scene &scene, const Discretization &discretization,
                        const ActingConstraints &acting,
                        const std::map<const Constraint *, std::size_t> &support_of) {
  std::vector<SupportedNode> nodes;
  const auto acts = [&acting](const Constraint &constraint) { return acting(constraint); };
  for (const auto &[dof, held] : collect_constrained_nodes(scene, discretization, acts)) {
    SupportedNode node{held.dofs, held.position, {}};
    const std::vector<std::size_t> independent = find_independent(held.constraints, held.position);
    std::vector<Tensor<1, 3>> normals;
    for (const std::size_t h : independent)
      normals.push_back(held.constraints[h]->direction(held.position));
    for (std::size_t i = 0; i < normals.size(); ++i)
      node.parts.push_back(
          {support_of.at(held.constraints[independent[i]]), normals[i], dual_vector(normals, i)});
    nodes.push_back(node);
  }
  return nodes;
}

std::map<std::size_t, double> fading_supports(const Scene &scene, const ActingConstraints &acting,
                                              const ConstraintFilter &acts) {
  std::map<std::size_t, double> times;
  for (const auto &[constraint, index] : support_indices(scene))
    if (acting(*constraint) && !acts(*constraint) && constraint->times.fade_time > 0.)
      times[index] = constraint->times.fade_time;
  return times;
}

} // namespace billet
