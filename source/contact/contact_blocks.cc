// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/contact_blocks.h"

#include "billet/fail_together.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

namespace {

bool has_dof(const ContactBlocks::NodeDofs &dofs, const DofIndex dof) {
  return std::find(dofs.begin(), dofs.end(), dof) != dofs.end();
}

/// Returns the parts of a node: its own dofs, or all dofs on which those depend if others are among
/// them.
std::vector<ContactBlocks::NodeDofs> collect_parts(const ContactBlocks::NodeDofs &own,
                                                   const Constraints &links) {
  std::vector<DofIndex> all;
  for (const DofIndex dof : own)
    if (!links.is_constrained(dof))
      all.push_back(dof);
    else if (const auto *entries = links.get_constraint_entries(dof))
      for (const auto &entry : *entries)
        all.push_back(entry.first);
  if (std::all_of(all.begin(), all.end(), [&own](const DofIndex dof) { return has_dof(own, dof); }))
    return {own};
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::vector<ContactBlocks::NodeDofs> parts;
  for (std::size_t first = 0; first < all.size(); first += 3) {
    parts.emplace_back();
    for (unsigned int i = 0; i < 3; ++i)
      parts.back()[i] = first + i < all.size() ? all[first + i] : all[first]; // again, weight 0
  }
  return parts;
}

std::vector<ContactBlocks::NodeDofs> dofs_of(const LocalNodes &nodes,
                                             const std::vector<unsigned int> &local) {
  std::vector<ContactBlocks::NodeDofs> dofs;
  for (const unsigned int node : local)
    dofs.push_back(nodes.dofs(node));
  return dofs;
}

Constraints build_links(const Discretization &discretization) {
  const dealii::IndexSet &owned = discretization.owned_dofs(), &relevant = discretization.relevant_dofs();
  const auto links = collect_links(discretization.dof_handler(), relevant);
  return build_constraints(owned, relevant, {{links, {}}});
}

} // namespace

ContactBlocks::ContactBlocks(FacetContact &contact, const LocalNodes &nodes,
                             const std::vector<unsigned int> &local_nodes)
    : ContactBlocks(contact, dofs_of(nodes, local_nodes), build_links(nodes.discretization()),
                    nodes.discretization().communicator()) {}

ContactBlocks::ContactBlocks(FacetContact &contact, const std::vector<NodeDofs> &dofs,
                             const Constraints &links, MPI_Comm communicator)
    : contact_(contact), communicator_(communicator), dofs_(dofs) {
  std::vector<std::vector<NodeDofs>> of_nodes;
  std::size_t n_parts = 1;
  for (const auto &own : dofs) {
    of_nodes.push_back(collect_parts(own, links));
    n_parts = std::max(n_parts, of_nodes.back().size());
  }
  parts_.assign(dealii::Utilities::MPI::max(n_parts, communicator),
                std::vector<NodeDofs>(dofs.size(), no_part()));
  for (std::size_t i = 0; i < dofs.size(); ++i)
    for (std::size_t p = 0; p < of_nodes[i].size(); ++p)
      parts_[p][i] = of_nodes[i][p];
}

ContactBlocks::Parts ContactBlocks::find_all_parts() const {
  Parts parts = parts_;
  for (auto &of_nodes : parts)
    contact_.exchange().update(of_nodes);
  return parts;
}

void ContactBlocks::find(const ContactTangent tangent) {
  const Parts parts = find_all_parts();
  couplings_.clear();
  contact_.couplings().find(tangent, [&](const std::vector<unsigned int> &nodes) {
    couplings_.emplace_back();
    std::vector<DofIndex> &dofs = couplings_.back();
    for (const unsigned int node : nodes)
      for_each_part(parts, node, [&](const std::size_t p) {
        dofs.insert(dofs.end(), parts[p][node].begin(), parts[p][node].end());
      });
    std::sort(dofs.begin(), dofs.end());
    dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
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

void ContactBlocks::resolve(const Constraints &constraints, const std::size_t node, Motions &motions) const {
  const NodeDofs &own = dofs_[node];
  const auto add = [&](const unsigned int i, const DofIndex dof, const double factor) {
    for (std::size_t p = 0; p < parts_.size(); ++p)
      for (unsigned int j = 0; j < 3; ++j)
        if (parts_[p][node][j] == dof) {
          motions[p][node].free[i][j] = factor;
          return;
        }
    AssertThrow(false, dealii::ExcMessage("A constraint of a surface node names a dof that is not linked."));
  };
  for (unsigned int i = 0; i < 3; ++i) {
    if (!constraints.is_constrained(own[i])) {
      add(i, own[i], 1.);
      continue;
    }
    if (const auto *entries = constraints.get_constraint_entries(own[i]))
      for (const auto &[other, factor] : *entries)
        add(i, other, factor);
    motions[0][node].value[i] = constraints.get_inhomogeneity(own[i]);
  }
}

ContactBlocks::Motions ContactBlocks::resolve_all(const Constraints &constraints) const {
  // Only their own ranks know the constraints of ghost nodes.
  Motions motions(parts_.size(), std::vector<PartMotion>(dofs_.size()));
  for (std::size_t node = 0; node < dofs_.size(); ++node)
    resolve(constraints, node, motions);
  for (auto &of_nodes : motions)
    contact_.exchange().update(of_nodes);
  return motions;
}

void ContactBlocks::condense(const Parts &parts, const Motions &motions,
                             const std::vector<unsigned int> &nodes, const dealii::FullMatrix<double> &K,
                             Block &block) {
  auto &[dofs, half, condensed] = block;
  dofs.clear();
  for (const unsigned int node : nodes)
    for_each_part(parts, node, [&](const std::size_t p) {
      dofs.insert(dofs.end(), parts[p][node].begin(), parts[p][node].end());
    });
  const std::size_t n = K.m(), n_dofs = dofs.size();
  half.reinit(n, n_dofs);
  condensed.reinit(n_dofs, n_dofs);
  std::size_t first = 0; // dof of the part
  for (std::size_t b = 0; b < nodes.size(); ++b)
    for_each_part(parts, nodes[b], [&](const std::size_t p) {
      const auto &free = motions[p][nodes[b]].free;
      for (std::size_t row = 0; row < n; ++row)
        for (unsigned int j = 0; j < 3; ++j)
          for (unsigned int k = 0; k < 3; ++k)
            half(row, first + j) += K(row, 3 * b + k) * free[k][j];
      first += 3;
    });
  first = 0;
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for_each_part(parts, nodes[a], [&](const std::size_t p) {
      const auto &free = motions[p][nodes[a]].free;
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int i = 0; i < 3; ++i)
          for (std::size_t column = 0; column < n_dofs; ++column)
            condensed(first + i, column) += free[k][i] * half(3 * a + k, column);
      first += 3;
    });
}

void ContactBlocks::add_lift(const Parts &parts, const Motions &motions,
                             const std::vector<unsigned int> &nodes, const dealii::FullMatrix<double> &K,
                             std::vector<FacetSearch::Positions> &lift) {
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    Tensor<1, 3> force;
    for (unsigned int k = 0; k < 3; ++k)
      for (std::size_t b = 0; b < nodes.size(); ++b)
        for (unsigned int j = 0; j < 3; ++j)
          force[k] -= K(3 * a + k, 3 * b + j) * motions[0][nodes[b]].value[j];
    for_each_part(parts, nodes[a], [&](const std::size_t p) {
      const auto &free = motions[p][nodes[a]].free;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int k = 0; k < 3; ++k)
          lift[p][nodes[a]][i] += free[k][i] * force[k];
    });
  }
}

void ContactBlocks::add_tangent(const ContactTangent tangent, const TangentSystem &system) const {
  const Motions motions = resolve_all(system.constraints);
  // Indices of ghosts may have changed since the couplings were found.
  const Parts parts = find_all_parts();
  std::vector<FacetSearch::Positions> lift;
  if (system.lift != nullptr)
    lift.assign(parts.size(), FacetSearch::Positions(parts[0].size()));
  Block block;
  contact_.tangents().visit(tangent,
                            [&](const std::vector<unsigned int> &nodes, const dealii::FullMatrix<double> &K) {
                              condense(parts, motions, nodes, K, block);
                              if (system.lift != nullptr)
                                add_lift(parts, motions, nodes, K, lift);
                              block.condensed *= system.weight;
                              system.matrix.add(block.dofs, block.condensed, false);
                            });
  for (std::size_t p = 0; p < lift.size(); ++p) {
    contact_.exchange().collect(lift[p]);
    for (auto &force : lift[p])
      force *= system.weight;
    for (std::size_t i = 0; i < dofs_.size(); ++i)
      if (parts_[p][i] != no_part())
        system.lift->add(3, parts_[p][i].data(), lift[p][i].begin_raw());
  }
}

std::vector<double> ContactBlocks::first_dofs() const {
  std::vector<double> dofs;
  for (const auto &own : dofs_)
    dofs.push_back(static_cast<double>(own[0]));
  return dofs;
}

void ContactBlocks::save(StateWriter &writer, const std::vector<std::uint64_t> &keys,
                         const std::vector<double> &of) const {
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator_);
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
      reader.n_ranks() != dealii::Utilities::MPI::n_mpi_processes(communicator_))
    return false;
  const bool is_same = reader.read_rows("dofs", 1, keys) == first_dofs();
  if (dealii::Utilities::MPI::min(is_same ? 1 : 0, communicator_) == 0)
    return false;
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator_);
  const std::vector<double> numbers = read_list(reader, "coupled dofs", rank);
  const std::vector<double> facets = read_list(reader, "coupled facets", rank);
  DofIndex last = 0; // coupled dofs are those of the surface nodes of all ranks
  for (const auto &part : parts_)
    for (const NodeDofs &dofs : part)
      if (dofs != no_part())
        last = std::max(last, *std::max_element(dofs.begin(), dofs.end()));
  last = dealii::Utilities::MPI::max(last, communicator_);
  couplings_.clear();
  fail_together(communicator_, [&] {
    for (RowReader row(numbers); !row.is_at_end();) {
      couplings_.emplace_back(to_count(row.number(), numbers.size()));
      for (DofIndex &dof : couplings_.back())
        dof = to_count(row.number(), last);
    }
    contact_.couplings().set(facets);
  });
  return true;
}

} // namespace billet
