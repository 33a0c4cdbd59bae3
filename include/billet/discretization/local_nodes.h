// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_LOCAL_NODES_H
#define BILLET_DISCRETIZATION_LOCAL_NODES_H

#include "billet/discretization/discretization.h"
#include "billet/mechanics/nodal_vectors.h"

#include <deal.II/base/aligned_vector.h>

#include <unordered_map>
#include <vector>

namespace billet {

/// Vectors at the local nodes, `nodal_stride` numbers apart.
using NodalVectors = dealii::AlignedVector<double>;

/// Nodes of the elements that a rank owns, for schemes without a matrix, numbered from 0 in the
/// order of the elements. Each rank has its own copy of a shared node. All ranks sum the
/// contributions to it in the same order, in sum_shared(), so that results are bitwise equal.
class LocalNodes {
public:
  explicit LocalNodes(const Discretization &discretization);
  ~LocalNodes();

  const Discretization &discretization() const { return discretization_; }
  unsigned int size() const { return static_cast<unsigned int>(dofs_.size()); }
  /// Returns the nodes of a body's elements, in the order of Discretization::elements().
  const std::vector<std::array<unsigned int, n_element_nodes>> &elements(const std::size_t body) const {
    return elements_[body];
  }
  /// Returns the undeformed positions.
  const NodalVectors &positions() const { return positions_; }
  const std::array<DofIndex, 3> &dofs(const unsigned int node) const { return dofs_[node]; }
  /// Returns the node with this first dof; numbers::invalid_unsigned_int if it is not on this rank.
  unsigned int find(DofIndex first_dof) const;
  /// Whether this rank counts the node in sums over all ranks.
  bool is_owned(const unsigned int node) const { return is_owned_[node]; }

  NodalVectors make_vectors() const { return NodalVectors(std::size_t{nodal_stride} * size(), 0.); }
  /// Replaces the entries of shared nodes by their sums over the ranks. Collective.
  void sum_shared(NodalVectors &values) const;
  /// Copies values into a ghosted vector. Collective.
  void copy(const NodalVectors &from, Vector &to) const;

private:
  void find_sharers();

  const Discretization &discretization_;
  std::vector<std::array<DofIndex, 3>> dofs_;
  std::unordered_map<DofIndex, unsigned int> index_;
  std::vector<std::vector<std::array<unsigned int, n_element_nodes>>> elements_;
  NodalVectors positions_;
  std::vector<bool> is_owned_;

  struct Neighbour {
    unsigned int rank;
    std::vector<unsigned int> nodes;    ///< shared nodes, in the order of their dofs
    std::vector<double> sent, received; ///< buffers, so that a sum allocates nothing
  };
  /// Contributions to the sum of a shared node, in the order of the ranks: the neighbour and the
  /// entry in its buffer. This rank itself is own_part.
  struct SharedNode {
    unsigned int node;
    std::vector<std::pair<unsigned int, unsigned int>> parts;
  };
  static constexpr unsigned int own_part = dealii::numbers::invalid_unsigned_int;
  mutable std::vector<Neighbour> neighbours_;
  mutable std::vector<MPI_Request> requests_;
  std::vector<SharedNode> shared_;
};

} // namespace billet

#endif
