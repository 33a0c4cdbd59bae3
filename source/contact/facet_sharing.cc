// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_sharing.h"

#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/planed_facet.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

bool meet_smoothly(const Tensor<1, 3> &normal, const Tensor<1, 3> &other) { return normal * other > 0.5; }

double part_at_ridge(const double depth, const double touched_depth) {
  constexpr double full = 1.05, none = 1.1;
  const double ratio = std::max(depth / touched_depth, touched_depth / depth);
  return std::clamp((none - ratio) / (none - full), 0., 1.);
}

namespace {

/// Whether facets with these unit normals meet in an edge whose wedge is not so thin, above 60 degrees, that
/// their normals nearly cancel.
bool form_ridge(const PlanedFacet &a, const PlanedFacet &b) {
  const Tensor<1, 3> from_a_to_b = b.centre() - a.centre();
  return from_a_to_b * a.normal() < 0. && from_a_to_b * b.normal() > 0. && a.normal() * b.normal() > -0.5;
}

} // namespace

template <class Facet>
SharedGap share_facets(const MovedFacets &facets, const TouchedFacet &touched, const unsigned int node,
                       const double raised, const ContactLimits &limits, std::vector<FacetShare> &shares) {
  const FacetSearch &search = facets.search();
  const FacetProjection &own = touched.projection;
  const Tensor<1, 3> &x = facets.position(node);
  const std::size_t first = shares.size();
  bool has_ridge = false;
  const auto part_of = [&](const unsigned int f, const FacetProjection &p) {
    if (meet_smoothly(own.normal, p.normal))
      return p.share;
    const double depth = raised - p.gap, own_depth = raised - own.gap;
    if (!(depth > 0.) || !(own_depth > 0.))
      return 0.;
    const double part = part_at_ridge(depth, own_depth);
    const bool is_shared =
        part > 0. && form_ridge(facets.plane(touched.facet), facets.plane(f)) &&
        (limits.max_alignment >= 1. || compute_node_normal(facets, node) * p.normal < limits.max_alignment);
    has_ridge = has_ridge || is_shared;
    return is_shared ? part * p.share : 0.;
  };
  // Twice the zone, since that of a larger neighbour is wider: (1 − |ξ|)/2 is the distance from the edge.
  const double inner = 1. - 4. * limits.zone;
  if (std::max(std::abs(own.parameters[0]), std::abs(own.parameters[1])) > inner)
    search.visit_around(search.nearest_corner(touched.facet, own.parameters), [&](const unsigned int f) {
      if (f == touched.facet) {
        shares.push_back({f, own.share, own});
        return;
      }
      const FacetProjection p = facets.project<Facet>(f, x, make_limits(limits.zone, limits));
      const double part = p.exists && p.share > 0. ? part_of(f, p) : 0.;
      if (part > 0.)
        shares.push_back({f, part, p});
    });
  if (shares.size() <= first + 1) { // its own share may be 0
    shares.resize(first);
    shares.push_back({touched.facet, 1., own});
    return {own.normal, own.gap};
  }
  SharedGap result = combine(shares, first);
  if (has_ridge) {
    Tensor<1, 3> mean;
    for (std::size_t i = first; i < shares.size(); ++i)
      mean += shares[i].share * shares[i].projection.normal;
    result.gap *= mean.norm_square();
    result.energy_factor = 1. / mean.norm_square();
  }
  return result;
}

#define BILLET_INSTANTIATE(Facet)                                                                            \
  template SharedGap share_facets<Facet>(const MovedFacets &, const TouchedFacet &, unsigned int, double,    \
                                         const ContactLimits &, std::vector<FacetShare> &);
BILLET_INSTANTIATE(PlanedFacet)
BILLET_INSTANTIATE(MeanGapFacet)
BILLET_INSTANTIATE(BilinearFacet)
#undef BILLET_INSTANTIATE

} // namespace billet
