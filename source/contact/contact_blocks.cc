// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/contact_blocks.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

namespace {

/// Constraints of a node's dofs, without dofs of other nodes: u = free u + value.
struct NodeConstraint {
  std::array<std::array<double, 3>, 3> free{{{1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}}};
  std::array<double, 3> value{};
};

NodeConstraint constraint_of(const Constraints &constraints, const std::array<DofIndex, 3> &dofs) {
  NodeConstraint result;
  for (unsigned int i = 0; i < 3; ++i) {
    if (!constraints.is_constrained(dofs[i]))
      continue;
    result.free[i] = {};
    if (const auto *entries = constraints.get_constraint_entries(dofs[i]))
      for (const auto &[other, factor] : *entries) {
        const auto *const found = std::find(dofs.begin(), dofs.end(), other);
        AssertThrow(found != dofs.end(), dealii::ExcNotImplemented());
        result.free[i][found - dofs.begin()] = factor;
      }
    result.value[i] = constraints.get_inhomogeneity(dofs[i]);
  }
  return result;
}

} // namespace

std::vector<std::array<DofIndex, 3>> ContactBlocks::find_all_dofs() const {
  std::vector<std::array<DofIndex, 3>> dofs;
  for (const unsigned int node : local_nodes_)
    dofs.push_back(nodes_.dofs(node));
  contact_.exchange().update(dofs);
  return dofs;
}

void ContactBlocks::find(const ContactTangent tangent) {
  const auto all_dofs = find_all_dofs();
  couplings_.clear();
  contact_.couplings().find(tangent, [&](const std::vector<unsigned int> &nodes) {
    couplings_.emplace_back();
    std::vector<DofIndex> &dofs = couplings_.back();
    for (const unsigned int node : nodes)
      dofs.insert(dofs.end(), all_dofs[node].begin(), all_dofs[node].end());
    std::sort(dofs.begin(), dofs.end());
  });
}

void ContactBlocks::add_foreign_dofs(dealii::IndexSet &dofs) const {
  for (const auto &coupled : couplings_)
    dofs.add_indices(coupled.begin(), coupled.end());
}

void ContactBlocks::add_entries(SparsityPattern &pattern) const {
  for (const auto &dofs : couplings_)
    for (const DofIndex row : dofs)
      pattern.add_entries(row, dofs.begin(), dofs.end(), true);
}

void ContactBlocks::add_tangent(const ContactTangent tangent, const TangentSystem &system) const {
  // Only their own ranks know the constraints of ghost nodes.
  std::vector<NodeConstraint> constraints;
  for (const unsigned int node : local_nodes_)
    constraints.push_back(constraint_of(system.constraints, nodes_.dofs(node)));
  contact_.exchange().update(constraints);
  const auto all_dofs = find_all_dofs(); // indices of ghosts may have changed since the couplings were found
  FacetSearch::Positions lift(all_dofs.size());
  dealii::FullMatrix<double> half, condensed;
  std::vector<DofIndex> dofs;
  contact_.tangents().visit(
      tangent, [&](const std::vector<unsigned int> &nodes, const dealii::FullMatrix<double> &K) {
        const std::size_t n = K.m();
        dofs.clear();
        half.reinit(n, n);
        condensed.reinit(n, n);
        for (std::size_t b = 0; b < nodes.size(); ++b) {
          const NodeConstraint &constraint = constraints[nodes[b]];
          dofs.insert(dofs.end(), all_dofs[nodes[b]].begin(), all_dofs[nodes[b]].end());
          for (std::size_t row = 0; row < n; ++row)
            for (unsigned int j = 0; j < 3; ++j)
              for (unsigned int k = 0; k < 3; ++k)
                half(row, 3 * b + j) += K(row, 3 * b + k) * constraint.free[k][j];
        }
        for (std::size_t a = 0; a < nodes.size(); ++a) {
          const NodeConstraint &constraint = constraints[nodes[a]];
          Tensor<1, 3> force;
          for (unsigned int k = 0; k < 3; ++k) {
            for (unsigned int i = 0; i < 3; ++i)
              for (std::size_t column = 0; column < n; ++column)
                condensed(3 * a + i, column) += constraint.free[k][i] * half(3 * a + k, column);
            for (std::size_t b = 0; b < nodes.size(); ++b)
              for (unsigned int j = 0; j < 3; ++j)
                force[k] -= K(3 * a + k, 3 * b + j) * constraints[nodes[b]].value[j];
          }
          for (unsigned int i = 0; i < 3; ++i)
            for (unsigned int k = 0; k < 3; ++k)
              lift[nodes[a]][i] += constraint.free[k][i] * force[k];
        }
        condensed *= system.weight;
        system.matrix.add(dofs, condensed, false);
      });
  if (system.lift == nullptr)
    return;
  contact_.exchange().collect(lift);
  for (auto &force : lift)
    force *= system.weight;
  for (std::size_t i = 0; i < local_nodes_.size(); ++i)
    system.lift->add(3, nodes_.dofs(local_nodes_[i]).data(), lift[i].begin_raw());
}

std::vector<double> ContactBlocks::first_dofs() const {
  std::vector<double> dofs;
  for (const unsigned int node : local_nodes_)
    dofs.push_back(static_cast<double>(nodes_.dofs(node)[0]));
  return dofs;
}

void ContactBlocks::save(StateWriter &writer, const std::vector<std::uint64_t> &keys,
                         const std::vector<double> &of) const {
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator());
  std::vector<double> numbers;
  for (const auto &dofs : couplings_) {
    numbers.push_back(static_cast<double>(dofs.size()));
    for (const DofIndex dof : dofs)
      numbers.push_back(static_cast<double>(dof));
  }
  writer.write("couplings of", of);
  writer.write_rows("dofs", 1, keys, first_dofs());
  write_list(writer, "coupled dofs", rank, numbers);
  write_list(writer, "coupled facets", rank, contact_.couplings().numbers());
}

bool ContactBlocks::load(const StateReader &reader, const std::vector<std::uint64_t> &keys,
                         const std::vector<double> &of) {
  if (!reader.has("couplings of") || reader.read("couplings of") != of ||
      reader.n_ranks() != dealii::Utilities::MPI::n_mpi_processes(communicator()))
    return false;
  const bool is_same = reader.read_rows("dofs", 1, keys) == first_dofs();
  if (dealii::Utilities::MPI::min(is_same ? 1 : 0, communicator()) == 0)
    return false;
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator());
  const std::vector<double> numbers = read_list(reader, "coupled dofs", rank);
  couplings_.clear();
  for (std::size_t i = 0; i < numbers.size();) {
    const auto n = static_cast<std::size_t>(numbers[i++]);
    couplings_.emplace_back();
    for (const std::size_t end = i + n; i < end; ++i)
      couplings_.back().push_back(static_cast<DofIndex>(numbers[i]));
  }
  contact_.couplings().set(read_list(reader, "coupled facets", rank));
  return true;
}

} // namespace billet
