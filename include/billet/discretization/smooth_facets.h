// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_SMOOTH_FACETS_H
#define BILLET_DISCRETIZATION_SMOOTH_FACETS_H

#include "billet/algebra/vector.h"
#include "billet/discretization/boundary_facets.h"
#include "billet/geometry/facet_bulge.h"

#include <array>
#include <vector>

namespace billet {

/// Facet with the smooth surface that it represents, that of mean nodal normals, (C9).
struct SmoothFacet {
  FacetCorners corners;
  std::array<DofIndex, 4> nodes; ///< the first dof of each
  dealii::Tensor<1, 3> normal;   ///< unit
  double size;                   ///< [length]
  FacetBulge bulge{};
  double curvature = 0.; ///< maximum of 8 b/L² over the edges [1/length]; > 0: convex
};

/// Returns the mean distance between a facet and its smooth surface, if that stays on one side. In
/// (C8) each height has a function of mean 1/3, so that this is a third of Σ|b_i| [length].
double mean_distance(const FacetBulge &bulge);

/// Returns the smooth facets of all ranks, made of those that each rank gives: first its own, in
/// their order, then those of others. Facets that meet at more than 50 degrees do not share a
/// normal. Undeformed or with these (ghosted) displacements. Collective.
std::vector<SmoothFacet> make_smooth_facets(const Discretization &discretization,
                                            const std::vector<BoundaryFacet> &own_facets,
                                            const Vector *displacements = nullptr);

} // namespace billet

#endif
