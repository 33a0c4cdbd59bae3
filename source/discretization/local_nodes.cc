// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/local_nodes.h"

#include <algorithm>
#include <map>
#include <set>

namespace billet {

LocalNodes::LocalNodes(const Discretization &discretization) : discretization_(discretization) {
  elements_.resize(discretization.n_bodies());
  std::vector<dealii::Tensor<1, 3>> positions;
  for (std::size_t body = 0; body < elements_.size(); ++body)
    for (const auto &element : discretization.elements(body)) {
      std::array<unsigned int, n_element_nodes> nodes{};
      for (unsigned int a = 0; a < n_element_nodes; ++a) {
        const DofIndex first = element.dofs[std::size_t{3} * a];
        const auto [entry, is_new] = index_.emplace(first, size());
        nodes[a] = entry->second;
        if (is_new) {
          dofs_.push_back({first, element.dofs[3 * a + 1], element.dofs[3 * a + 2]});
          positions.push_back(element.cell->vertex(a));
        }
      }
      elements_[body].push_back(nodes);
    }
  positions_ = make_vectors();
  for (unsigned int node = 0; node < size(); ++node)
    add_vector(positions_.data(), node, positions[node]);
  find_sharers();
}

LocalNodes::~LocalNodes() = default;

unsigned int LocalNodes::find(const DofIndex first_dof) const {
  const auto entry = index_.find(first_dof);
  return entry == index_.end() ? dealii::numbers::invalid_unsigned_int : entry->second;
}

void LocalNodes::find_sharers() {
  // All cells around a node are on this rank, owned or as ghosts, and know their owners.
  std::vector<std::set<unsigned int>> ranks(size());
  for (const auto &cell : discretization_.dof_handler().active_cell_iterators()) {
    if (cell->is_artificial())
      continue;
    for (const unsigned int v : cell->vertex_indices()) {
      const unsigned int node = find(cell->vertex_dof_index(v, 0));
      if (node != dealii::numbers::invalid_unsigned_int)
        ranks[node].insert(cell->subdomain_id());
    }
  }
  const unsigned int here = dealii::Utilities::MPI::this_mpi_process(discretization_.communicator());
  std::map<unsigned int, std::vector<unsigned int>> shared_with;
  is_owned_.resize(size());
  for (unsigned int node = 0; node < size(); ++node) {
    is_owned_[node] = *ranks[node].begin() == here;
    for (const unsigned int rank : ranks[node])
      if (rank != here)
        shared_with[rank].push_back(node);
  }
  std::map<unsigned int, SharedNode> shared;
  for (auto &[rank, nodes] : shared_with) {
    std::sort(nodes.begin(), nodes.end(),
              [this](const unsigned int a, const unsigned int b) { return dofs_[a][0] < dofs_[b][0]; });
    const std::size_t n = nodal_stride * nodes.size();
    neighbours_.push_back({rank, nodes, std::vector<double>(n), std::vector<double>(n)});
  }
  requests_.resize(2 * neighbours_.size());
  for (unsigned int n = 0; n < neighbours_.size(); ++n)
    for (unsigned int i = 0; i < neighbours_[n].nodes.size(); ++i) {
      const unsigned int node = neighbours_[n].nodes[i];
      SharedNode &entry = shared[node];
      entry.node = node;
      const bool own_is_next = std::none_of(entry.parts.begin(), entry.parts.end(),
                                            [](const auto &part) { return part.first == own_part; }) &&
                               neighbours_[n].rank > here;
      if (own_is_next)
        entry.parts.emplace_back(own_part, 0);
      entry.parts.emplace_back(n, i);
    }
  for (auto &[node, entry] : shared) {
    if (std::none_of(entry.parts.begin(), entry.parts.end(),
                     [](const auto &part) { return part.first == own_part; }))
      entry.parts.emplace_back(own_part, 0);
    shared_.push_back(entry);
  }
}

void LocalNodes::sum_shared(NodalVectors &values) const {
  if (neighbours_.empty())
    return;
  const MPI_Comm communicator = discretization_.communicator();
  constexpr int tag = 71;
  for (std::size_t n = 0; n < neighbours_.size(); ++n) {
    auto &[rank, nodes, sent, received] = neighbours_[n];
    MPI_Irecv(received.data(), static_cast<int>(received.size()), MPI_DOUBLE, static_cast<int>(rank), tag,
              communicator, &requests_[2 * n]);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      std::copy_n(&values[std::size_t{nodal_stride} * nodes[i]], nodal_stride, &sent[nodal_stride * i]);
    MPI_Isend(sent.data(), static_cast<int>(sent.size()), MPI_DOUBLE, static_cast<int>(rank), tag,
              communicator, &requests_[2 * n + 1]);
  }
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  for (const auto &[node, parts] : shared_) {
    std::array<double, nodal_stride> sum{};
    for (const auto &[neighbour, entry] : parts) {
      const double *part = neighbour == own_part
                               ? &values[std::size_t{nodal_stride} * node]
                               : &neighbours_[neighbour].received[std::size_t{nodal_stride} * entry];
      for (unsigned int i = 0; i < nodal_stride; ++i)
        sum[i] += part[i];
    }
    std::copy(sum.begin(), sum.end(), &values[std::size_t{nodal_stride} * node]);
  }
}

void LocalNodes::copy(const NodalVectors &from, Vector &to) const {
  Vector owned = discretization_.make_owned_vector();
  for (unsigned int node = 0; node < size(); ++node)
    for (unsigned int i = 0; i < 3; ++i)
      if (discretization_.owned_dofs().is_element(dofs_[node][i]))
        owned(dofs_[node][i]) = from[std::size_t{nodal_stride} * node + i];
  owned.compress(dealii::VectorOperation::insert);
  to = owned;
}

} // namespace billet
