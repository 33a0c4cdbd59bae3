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

/// Contribution of contact between bodies to the matrix: the coupled entries, and the tangents with
/// the constraints of nodes of all ranks.
///
/// A constrained node moves by u = Σ_p C_p v_p + value, where each part v_p consists of three dofs.
/// Most nodes have one part, their own dofs, to which supports refer. Hanging nodes have one part
/// for each node on which they depend.
class ContactBlocks {
public:
  using NodeDofs = std::array<DofIndex, 3>;

  /// `local_nodes` are the surface nodes of `contact`. Collective.
  ContactBlocks(FacetContact &contact, const LocalNodes &nodes, const std::vector<unsigned int> &local_nodes);
  /// `dofs` are those of the surface nodes of `contact`, which must outlive this object. `links`
  /// are the closed constraints that may name dofs of other nodes. Those of add_tangent() may also
  /// name other dofs of the same node, or of the nodes that `links` name. Collective.
  ContactBlocks(FacetContact &contact, const std::vector<NodeDofs> &dofs, const Constraints &links,
                MPI_Comm communicator);

  /// Finds the dofs that add_tangent() may couple. Collective.
  void find(ContactTangent tangent);
  /// Whether add_tangent() has entries of this rank that the last find() did not include.
  bool has_new() const { return contact_.couplings().has_new(); }
  void add_foreign_dofs(dealii::IndexSet &dofs) const;
  void add_entries(SparsityPattern &pattern) const;
  /// Adds −∂F_c/∂u [force/length]. Collective.
  void add_tangent(ContactTangent tangent, const TangentSystem &system) const;

  /// Saves the result of the last find(). `of` are any numbers that identify what the blocks depend
  /// on.
  void save(StateWriter &writer, const std::vector<std::uint64_t> &keys, const std::vector<double> &of) const;
  /// Loads a saved result in place of find(). Returns false, on all ranks, if other ranks saved it
  /// or `of` differs.
  bool load(const StateReader &reader, const std::vector<std::uint64_t> &keys, const std::vector<double> &of);

private:
  /// Dofs of the p-th part of each surface node, and of its ghosts where exchanged; no_part() if it
  /// has fewer.
  using Parts = std::vector<std::vector<NodeDofs>>;
  static constexpr NodeDofs no_part() { return {no_dof, no_dof, no_dof}; }
  static constexpr DofIndex no_dof = dealii::numbers::invalid_dof_index;

  /// Motion of a node by one part, free · v; that by the first part has the value.
  struct PartMotion {
    std::array<std::array<double, 3>, 3> free{};
    std::array<double, 3> value{};
  };

  using Motions = std::vector<std::vector<PartMotion>>; ///< as Parts

  /// Block of a tangent and what it becomes with the constraints; memory for many.
  struct Block {
    std::vector<DofIndex> dofs; ///< of all parts of all nodes; some may appear twice
    dealii::FullMatrix<double> half, condensed;
  };

  /// Calls visit(p) for each part of a node.
  template <class Visit>
  static void for_each_part(const Parts &parts, const std::size_t node, const Visit &visit) {
    for (std::size_t p = 0; p < parts.size() && parts[p][node][0] != no_dof; ++p)
      visit(p);
  }
  /// Returns the parts of surface nodes and ghosts. Collective.
  Parts find_all_parts() const;
  /// Returns the motions of surface nodes and ghosts. Collective.
  Motions resolve_all(const Constraints &constraints) const;
  /// Sets the motions of a surface node.
  void resolve(const Constraints &constraints, std::size_t node, Motions &motions) const;
  /// Computes Cᵀ K C.
  static void condense(const Parts &parts, const Motions &motions, const std::vector<unsigned int> &nodes,
                       const dealii::FullMatrix<double> &K, Block &block);
  /// Adds −Cᵀ K value to `lift`, of each part.
  static void add_lift(const Parts &parts, const Motions &motions, const std::vector<unsigned int> &nodes,
                       const dealii::FullMatrix<double> &K, std::vector<FacetSearch::Positions> &lift);
  std::vector<double> first_dofs() const;

  FacetContact &contact_;
  MPI_Comm communicator_;
  std::vector<NodeDofs> dofs_;
  Parts parts_;                                  ///< of surface nodes; as many on all ranks
  std::vector<std::vector<DofIndex>> couplings_; ///< fully coupled dofs, ascending
};

} // namespace billet

#endif
