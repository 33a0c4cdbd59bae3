// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_FACET_METHOD_H
#define BILLET_GEOMETRY_FACET_METHOD_H

namespace billet {

/// Representation of a facet for the nodes that touch it.
enum class FacetMethod {
  planed,   ///< PlanedFacet: no iteration
  mean_gap, ///< MeanGapFacet
  bilinear, ///< BilinearFacet: without friction, forces at a fixed area have a potential
  overlap   ///< FacetOverlapOf: facets, not nodes, touch on their common polygon
};

} // namespace billet

#endif
