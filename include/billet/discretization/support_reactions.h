// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_SUPPORT_REACTIONS_H
#define BILLET_DISCRETIZATION_SUPPORT_REACTIONS_H

#include "billet/discretization/local_nodes.h"
#include "billet/discretization/support_parts.h"

#include <string>
#include <vector>

namespace billet {

/// Force and moment that act on bodies.
struct Resultant {
  dealii::Tensor<1, 3> force;  ///< [force]
  dealii::Tensor<1, 3> moment; ///< about the origin, at deformed positions [force length]
};

/// Replaces each by its sum over the ranks. Collective.
void sum_over_ranks(std::vector<Resultant> &resultants, MPI_Comm communicator);

/// Support or symmetry plane of a body.
struct NamedSupport {
  std::size_t body;
  std::string name; ///< as Constraint::name: "support NAME" or "symmetry plane TEXT"
};

/// Returns the symmetry planes and supports of all bodies, body by body in the order of
/// Body::constraints. The components of a support are one entry.
std::vector<NamedSupport> named_supports(const Scene &scene);

/// Forces of supports and symmetry planes on the bodies, from the residual of all other forces:
/// R_a = Σ λ n + free residual at a node a. Each constraint n · u = value takes a force along n
/// alone. Where normals depend on each other, the constraint that stands first in Body::constraints
/// takes the force. Symmetry planes stand before supports, and these are in the order of the scene.
/// The sum of all reactions is therefore that of the node.
class SupportReactions {
public:
  /// For the supports and symmetry planes that act.
  SupportReactions(const Scene &scene, const Discretization &discretization, const ActingConstraints &acting);

  /// Follows supports that have begun or ended since the last call.
  void follow(const ActingConstraints &acting);

  /// Reactions, and what the constraints leave of the residual.
  struct Forces {
    std::vector<Resultant> of_supports; ///< in the order of named_supports()
    dealii::Tensor<1, 3> free;          ///< sum of the residual that no constraint takes
  };
  /// Returns the reactions of this residual (owned, without constraints) at these displacements.
  /// Forces at hanging nodes count at the nodes on which these depend. Collective.
  Forces compute(Vector residual, const Vector &displacements) const;
  /// Returns the reactions of forces of the constraints at the nodes. They are the same on all
  /// ranks that have a node. The free residual is that of constrained nodes. Collective.
  Forces compute(const LocalNodes &nodes, const NodalVectors &forces,
                 const NodalVectors &displacements) const;

private:
  void collect_nodes(const ActingConstraints &acting);
  Forces sum_over_ranks(Forces own) const;
  static void add(const SupportedNode &node, const dealii::Tensor<1, 3> &displacement,
                  const dealii::Tensor<1, 3> &residual, Forces &sums);

  const Scene &scene_;
  const Discretization &discretization_;
  std::map<const Constraint *, std::size_t> support_of_; ///< indices in named_supports()
  unsigned int n_changes_ = 0;                           ///< of the supports that nodes_ know
  std::size_t n_supports_;
  std::vector<SupportedNode> nodes_; ///< owned by this rank
  Constraints links_;                ///< of hanging nodes
  bool couples_ranks_ = false;
};

} // namespace billet

#endif
