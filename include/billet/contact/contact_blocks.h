// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CONTACT_BLOCKS_H
#define BILLET_CONTACT_CONTACT_BLOCKS_H

#include "billet/algebra/matrix.h"
#include "billet/contact/facet_contact.h"
#include "billet/discretization/local_nodes.h"
#include "billet/discretization/supports.h"
#include "billet/state.h"

#include <string>
#include <vector>

namespace billet {

/// Contribution of contact between bodies to the matrix: the coupled entries, and the tangents with the
/// constraints of nodes of all ranks.
///
/// Constraints may name only other dofs of the same node, as those of supports do.
class ContactBlocks {
public:
  /// `local_nodes` are the surface nodes of `contact`. All must outlive this object.
  ContactBlocks(FacetContact &contact, const LocalNodes &nodes, const std::vector<unsigned int> &local_nodes)
      : contact_(contact), nodes_(nodes), local_nodes_(local_nodes) {}

  /// Finds the dofs that add_tangent() may couple. Collective.
  void find(ContactTangent tangent);
  /// Whether add_tangent() has entries of this rank that the last find() did not include.
  bool has_new() const { return contact_.couplings().has_new(); }
  void add_foreign_dofs(dealii::IndexSet &dofs) const;
  void add_entries(SparsityPattern &pattern) const;
  /// Adds −∂F_c/∂u [force/length]. Collective.
  void add_tangent(ContactTangent tangent, const TangentSystem &system) const;

  /// Saves the result of the last find(). `of` are any numbers that identify what the blocks depend on.
  void save(StateWriter &writer, const std::vector<std::uint64_t> &keys, const std::vector<double> &of) const;
  /// Loads a saved result in place of find(). Returns false, on all ranks, if other ranks saved it or `of`
  /// differs.
  bool load(const StateReader &reader, const std::vector<std::uint64_t> &keys, const std::vector<double> &of);

private:
  MPI_Comm communicator() const { return nodes_.discretization().communicator(); }
  /// Returns the dofs of surface nodes and ghosts. Collective.
  std::vector<std::array<DofIndex, 3>> find_all_dofs() const;
  std::vector<double> first_dofs() const;

  FacetContact &contact_;
  const LocalNodes &nodes_;
  const std::vector<unsigned int> &local_nodes_;
  std::vector<std::vector<DofIndex>> couplings_; ///< fully coupled dofs, ascending
};

} // namespace billet

#endif
