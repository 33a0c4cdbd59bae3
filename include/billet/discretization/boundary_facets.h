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

/// Boundary face of an owned element. Its corners are in lexicographic order, (−1,−1), (1,−1),
/// (−1,1), (1,1), oriented so that ∂x/∂ξ × ∂x/∂η points out of the body.
struct BoundaryFacet {
  std::array<std::array<DofIndex, 3>, 4> dofs;
  std::array<dealii::Point<3>, 4> corners; ///< undeformed
  double thickness;                        ///< of its element: volume over the facet's area
  std::uint64_t key;                       ///< unique, the same on any number of ranks

  /// Returns the area vector of the undeformed facet, half the cross product of its diagonals
  /// [length²].
  dealii::Tensor<1, 3> area_vector() const {
    return 0.5 * dealii::cross_product_3d(corners[3] - corners[0], corners[2] - corners[1]);
  }
  /// Returns the integrals of the shape functions over the undeformed facet [length²].
  std::array<double, 4> corner_areas() const;
};

/// Returns the facets of a body on this rank whose boundary id is among `boundary_ids`.
std::vector<BoundaryFacet> collect_boundary_facets(const Discretization &discretization, std::size_t body,
                                                   const std::vector<unsigned int> &boundary_ids);

/// Returns all facets of a body on this rank, whatever their boundary ids.
std::vector<BoundaryFacet> collect_boundary_facets(const Discretization &discretization, std::size_t body);

/// Dimensions of the undeformed facets around a node [length].
struct FacetSize {
  double size = 0.;      ///< h, square root of their mean area
  double thickness = 0.; ///< of their elements: sum of volumes over sum of areas
};

/// Returns the facet size at each node of these facets, by its first dof, including facets of other
/// ranks. Collective.
std::map<DofIndex, FacetSize> compute_facet_sizes(const Discretization &discretization,
                                                  const std::vector<BoundaryFacet> &facets);

} // namespace billet

#endif
