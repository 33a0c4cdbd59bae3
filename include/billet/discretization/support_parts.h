// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_SUPPORT_PARTS_H
#define BILLET_DISCRETIZATION_SUPPORT_PARTS_H

#include "billet/discretization/discretization.h"
#include "billet/discretization/supports.h"

#include <array>
#include <map>
#include <vector>

namespace billet {

/// Constraint of a support or symmetry plane at a node. Of the residual R it takes (dual · R)
/// normal.
struct SupportPart {
  std::size_t support; ///< index in named_supports()
  dealii::Tensor<1, 3> normal, dual;

  dealii::Tensor<1, 3> force(const dealii::Tensor<1, 3> &residual) const {
    return (dual * residual) * normal;
  }
};

/// Node that supports or symmetry planes hold.
struct SupportedNode {
  std::array<DofIndex, 3> dofs;
  dealii::Point<3> position; ///< undeformed
  std::vector<SupportPart> parts;
};

/// Returns the indices in named_supports() of the constraints of a body; `first` is that of its
/// first one.
std::vector<std::size_t> support_indices(const Body &body, std::size_t first);
/// Returns the same for all constraints of the scene.
std::map<const Constraint *, std::size_t> support_indices(const Scene &scene);

/// Returns the nodes that the constraints hold that act, of own and ghost elements; `support_of`:
/// those of support_indices(). Where normals depend on each other, the constraint that stands first
/// takes the force.
std::vector<SupportedNode>
collect_supported_nodes(const Scene &scene, const Discretization &discretization,
                        const ActingConstraints &acting,
                        const std::map<const Constraint *, std::size_t> &support_of);

/// Returns the supports that act and that `acts` omits, and whose forces fade: their indices in
/// named_supports() and fade times.
std::map<std::size_t, double> fading_supports(const Scene &scene, const ActingConstraints &acting,
                                              const ConstraintFilter &acts);

} // namespace billet

#endif
