// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_AREAS_H
#define BILLET_CONTACT_FACET_AREAS_H

#include "billet/geometry/facet_projection.h"

namespace billet {

/// A slave node's share of one of its own facets, ∫ N_a <−ν·n> dξdη, with ν = x,ξ × x,η, by 2 × 2
/// Gauss points. It is the facet's area projected along the normal n of the touched surface,
/// weighted by the shape function of corner a. A facet that does not face the touched surface has
/// no share.
template <class Number> class FacetAreasOf {
public:
  explicit FacetAreasOf(const facet::ExpansionOf<Number> &surface);

  /// Returns the share of a corner [length²]; `normal` is a unit vector.
  Number share(unsigned int corner, const dealii::Tensor<1, 3, Number> &normal) const;

private:
  /// ν = constant + ξ along_xi + η along_eta.
  dealii::Tensor<1, 3, Number> constant_, along_xi_, along_eta_;
};
using FacetAreas = FacetAreasOf<double>;

} // namespace billet

#endif
