// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/forces/surface_coupling.h"

#include "billet/algebra/gather.h"
#include "billet/algebra/vector.h"
#include "billet/discretization/boundary_facets.h"
#include "billet/errors.h"
#include "billet/forces/selected_nodes.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace billet {

namespace {

/// Condenses an additive vector and returns its owned entries.
Vector condensed(const Discretization &discretization, const Constraints &constraints,
                 const bool couples_ranks, Vector &additive) {
  additive.compress(dealii::VectorOperation::add);
  Vector owned = discretization.make_owned_vector();
  owned = additive;
  condense(constraints, couples_ranks, owned);
  return owned;
}

/// Dofs of the nodes of a load: a node of several faces occurs several times.
using NodeDofs = std::vector<std::array<DofIndex, 3>>;

NodeDofs find_dofs(const AppliedLoad &load, const Discretization &discretization, const std::size_t body) {
  NodeDofs dofs;
  for (const SelectedNode &node : collect_selected_nodes(load, discretization, body))
    dofs.push_back(node.dofs);
  for (const BoundaryFacet &facet : collect_boundary_facets(discretization, body, load.boundary_ids))
    dofs.insert(dofs.end(), facet.dofs.begin(), facet.dofs.end());
  return dofs;
}

/// Calls visit(load, dofs of its nodes on this rank) for each load on a surface, or on nodes as a
/// whole.
template <class Visit>
void for_each_surface(const Scene &scene, const Discretization &discretization, const Visit &visit) {
  for (std::size_t body = 0; body < scene.bodies().size(); ++body)
    for (const AppliedLoad &load : scene.bodies()[body].loads)
      if (load.load.acts_on_surface())
        visit(load, find_dofs(load, discretization, body));
}

/// Returns the dofs of a surface's nodes and of those on which they depend, of all ranks, in their
/// order.
std::vector<DofIndex> find_coupled_dofs(const Discretization &discretization, const Constraints &constraints,
                                        const NodeDofs &nodes_of_load) {
  Vector marks = discretization.make_additive_vector();
  for (const auto &dofs : nodes_of_load)
    for (const DofIndex dof : dofs) {
      // Irregular numbers, so that none of their sums is 0.
      const double number = 0.618034 * static_cast<double>(dof);
      marks.add(1, &dof, std::array<double, 1>{1. + number - std::floor(number)}.data());
    }
  const dealii::IndexSet &owned = discretization.owned_dofs();
  marks.compress(dealii::VectorOperation::add);
  Vector of_nodes = discretization.make_owned_vector();
  of_nodes = marks;
  Vector of_masters(of_nodes);
  condense(constraints, couple_ranks(constraints, owned, discretization.communicator()), of_masters);
  const auto nodes = owned_values(of_nodes), masters = owned_values(of_masters);
  std::vector<DofIndex> own;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i] != 0. || masters[i] != 0.)
      own.push_back(owned.nth_index_in_set(i));
  std::vector<DofIndex> all = gather_all(discretization.communicator(), own);
  std::sort(all.begin(), all.end());
  return all;
}

} // namespace

void check_surface_couplings(const Scene &scene, const Discretization &discretization) {
  constexpr std::size_t max_nodes = 2000; // 36 million entries
  for_each_surface(scene, discretization, [&](const AppliedLoad &load, const NodeDofs &nodes_of_load) {
    std::set<DofIndex> own;
    for (const auto &dofs : nodes_of_load)
      own.insert(dofs[0]);
    const auto gathered =
        gather_all(discretization.communicator(), std::vector<DofIndex>(own.begin(), own.end()));
    const std::size_t n = std::set<DofIndex>(gathered.begin(), gathered.end()).size();
    if (n > max_nodes)
      throw InputError(load.origin + ": the " + load.type + " acts on " + std::to_string(n) +
                       " nodes, each of which depends on all others in the tangent; allowed are " +
                       std::to_string(max_nodes) +
                       ". Let it act on a part of the faces, or on faces of larger elements");
  });
}

void add_surface_couplings(const Scene &scene, const Discretization &discretization,
                           const Constraints &constraints, SparsityPattern &pattern) {
  for_each_surface(scene, discretization, [&](const AppliedLoad & /*load*/, const NodeDofs &nodes_of_load) {
    const auto dofs = find_coupled_dofs(discretization, constraints, nodes_of_load);
    for (const DofIndex row : dofs)
      if (discretization.owned_dofs().is_element(row))
        pattern.add_entries(row, dofs.begin(), dofs.end(), true);
  });
}

SurfaceCoupling::SurfaceCoupling(const Discretization &discretization) : discretization_(discretization) {
  for (unsigned int k = 0; k < n_factors; ++k) {
    left_.push_back(discretization.make_additive_vector());
    right_.push_back(discretization.make_additive_vector());
  }
}

void SurfaceCoupling::add(const std::array<DofIndex, 3> &dofs, const SurfaceLoad::Coupling &coupling) {
  for (unsigned int k = 0; k < n_factors; ++k) {
    std::array<double, 3> left{}, right{};
    for (unsigned int i = 0; i < 3; ++i) {
      left[i] = coupling.left[k / 3][i][k % 3];
      right[i] = coupling.right[k / 3][k % 3][i];
    }
    left_[k].add(3, dofs.data(), left.data());
    right_[k].add(3, dofs.data(), right.data());
  }
}

void SurfaceCoupling::add_to(const TangentSystem &system) {
  const dealii::IndexSet &owned = discretization_.owned_dofs();
  const MPI_Comm communicator = discretization_.communicator();
  const bool couples_ranks = couple_ranks(system.constraints, owned, communicator);
  std::vector<std::vector<double>> factors;
  for (auto *const vectors : {&left_, &right_})
    for (Vector &vector : *vectors) {
      const Vector entries = condensed(discretization_, system.constraints, couples_ranks, vector);
      const auto values = owned_values(entries);
      factors.emplace_back(values.begin(), values.end());
    }
  const auto is_zero = [&](const std::size_t i) {
    return std::all_of(factors.begin(), factors.end(), [i](const auto &values) { return values[i] == 0.; });
  };
  std::vector<DofIndex> own;
  std::vector<double> right; // of own dofs, one dof after the other
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < owned.n_elements(); ++i) {
    if (is_zero(i))
      continue;
    own.push_back(owned.nth_index_in_set(i));
    rows.push_back(i);
    for (unsigned int k = 0; k < n_factors; ++k)
      right.push_back(factors[n_factors + k][i]);
  }
  const std::vector<DofIndex> columns = gather_all(communicator, own);
  const std::vector<double> all = gather_all(communicator, right);
  std::vector<double> entries(columns.size());
  for (std::size_t r = 0; r < own.size(); ++r) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      entries[c] = 0.;
      for (unsigned int k = 0; k < n_factors; ++k)
        entries[c] += factors[k][rows[r]] * all[n_factors * c + k];
      entries[c] *= system.weight;
    }
    system.matrix.add(own[r], columns.size(), columns.data(), entries.data(), false);
  }
}

} // namespace billet
