// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_BOUNDARY_FACETS_H
#define BILLET_DISCRETIZATION_BOUNDARY_FACETS_H

#include "billet/discretization/discretization.h"
#include "billet/geometry/facet_point.h"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace billet {

/// A boundary face of an owned element. Corners in lexicographic order, (−1,−1), (1,−1), (−1,1), (1,1),
/// turned so that ∂x/∂ξ × ∂x/∂η points out of the body.
struct BoundaryFacet {
  std::array<std::array<DofIndex, 3>, 4> dofs;
  std::array<dealii::Point<3>, 4> corners; ///< undeformed
  double thickness;                        ///< of the element below it: its volume over the facet's area
  std::uint64_t key;                       ///< that no other has, the same on any number of ranks

  /// Of the undeformed facet, half the cross product of its diagonals [length²].
  dealii::Tensor<1, 3> area_vector() const {
    return 0.5 * dealii::cross_product_3d(corners[3] - corners[0], corners[2] - corners[1]);
  }
};

/// Facets of a body whose boundary id is among `boundary_ids`, on this rank.
std::vector<BoundaryFacet> collect_boundary_facets(const Discretization &discretization, std::size_t body,
                                                   const std::vector<unsigned int> &boundary_ids);

/// All facets of a body on this rank, whatever their boundary ids.
std::vector<BoundaryFacet> collect_boundary_facets(const Discretization &discretization, std::size_t body);

/// What the undeformed facets around a node are like [length].
struct FacetSize {
  double size = 0.;      ///< h, the root of their mean area
  double thickness = 0.; ///< of the elements below them: the volumes over the areas
};

/// At each node of these facets, by its first dof, with those of other ranks. Collective.
std::map<DofIndex, FacetSize> compute_facet_sizes(const Discretization &discretization,
                                                  const std::vector<BoundaryFacet> &facets);

} // namespace billet

#endif
