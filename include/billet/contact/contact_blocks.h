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

/// What contact between bodies adds to the matrix: the entries that it couples, and its tangents with the
/// constraints of nodes of all ranks.
///
/// Constraints may name only other dofs of the same node, as those of supports do.
class ContactBlocks {
public:
  /// `local_nodes` are the surface nodes of `contact`. All have to outlive this.
  ContactBlocks(FacetContact &contact, const LocalNodes &nodes, const std::vector<unsigned int> &local_nodes)
      : contact_(contact), nodes_(nodes), local_nodes_(local_nodes) {}

  /// Finds which dofs add_tangent() may couple. Collective.
  void find(ContactTangent tangent);
  /// Whether add_tangent() has entries of this rank that the last find() did not name.
  bool has_new() const { return contact_.couplings().has_new(); }
  void add_foreign_dofs(dealii::IndexSet &dofs) const;
  void add_entries(SparsityPattern &pattern) const;
  /// Adds −∂F_c/∂u [force/length]. Collective.
  void add_tangent(ContactTangent tangent, const TangentSystem &system) const;

  /// Saves what the last find() found, and for whom: any numbers that say what the blocks depend on.
  void save(StateWriter &writer, const std::vector<std::uint64_t> &keys, const std::vector<double> &of) const;
  /// Loads that in place of find(). False, on all ranks, if it was saved by other ranks or `of` others.
  bool load(const StateReader &reader, const std::vector<std::uint64_t> &keys, const std::vector<double> &of);

private:
  MPI_Comm communicator() const { return nodes_.discretization().communicator(); }
  /// Of surface nodes and ghosts. Collective.
  std::vector<std::array<DofIndex, 3>> find_all_dofs() const;
  std::vector<double> first_dofs() const;

  FacetContact &contact_;
  const LocalNodes &nodes_;
  const std::vector<unsigned int> &local_nodes_;
  std::vector<std::vector<DofIndex>> couplings_; ///< dofs that are coupled all with all, ascending
};

} // namespace billet

#endif
