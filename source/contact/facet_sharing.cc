// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_sharing.h"

#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/planed_facet.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

bool meet_smoothly(const Tensor<1, 3> &normal, const Tensor<1, 3> &other) {
  // Facets that meet at more than 60 degrees have an edge between them.
  constexpr double cosine_of_edge = 0.5;
  return normal * other > cosine_of_edge;
}

template <class Facet>
SharedGap share_facets(const MovedFacets &facets, const TouchedFacet &touched, const Tensor<1, 3> &x,
                       const ContactLimits &limits, std::vector<FacetShare> &shares) {
  const FacetSearch &search = facets.search();
  const FacetProjection &own = touched.projection;
  const std::size_t first = shares.size();
  // Twice the zone, since that of a larger neighbour is wider: (1 − |ξ|)/2 is the distance from the
  // edge.
  const double inner = 1. - 4. * limits.zone;
  if (std::max(std::abs(own.parameters[0]), std::abs(own.parameters[1])) > inner)
    search.visit_around(search.nearest_corner(touched.facet, own.parameters), [&](const unsigned int f) {
      if (f == touched.facet) {
        shares.push_back({f, own.share, own});
        return;
      }
      const FacetProjection p = facets.project<Facet>(f, x, make_limits(limits.zone, limits));
      if (p.exists && p.share > 0. && meet_smoothly(own.normal, p.normal))
        shares.push_back({f, p.share, p});
    });
  if (shares.size() <= first + 1) { // its own share may be 0
    shares.resize(first);
    shares.push_back({touched.facet, 1., own});
    return {own.normal, own.gap};
  }
  return combine(shares, first);
}

#define BILLET_INSTANTIATE(Facet)                                                                            \
  template SharedGap share_facets<Facet>(const MovedFacets &, const TouchedFacet &, const Tensor<1, 3> &,    \
                                         const ContactLimits &, std::vector<FacetShare> &);
BILLET_INSTANTIATE(PlanedFacet)
BILLET_INSTANTIATE(MeanGapFacet)
BILLET_INSTANTIATE(BilinearFacet)
#undef BILLET_INSTANTIATE

} // namespace billet
