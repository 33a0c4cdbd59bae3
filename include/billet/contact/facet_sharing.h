// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_SHARING_H
#define BILLET_CONTACT_FACET_SHARING_H

#include "billet/contact/facet_choice.h"

namespace billet {

/// A facet's part in the contact of a node.
struct FacetShare {
  unsigned int facet;
  double share; ///< >= 0; their sum is 1
  FacetProjection projection;
};

/// Normal and gap of a node with all facets that share it.
struct SharedGap {
  dealii::Tensor<1, 3> normal; ///< unit
  double gap;                  ///< [length]
};

/// Whether facets with these unit normals share a node on their border: at less than 60 degrees.
bool meet_smoothly(const dealii::Tensor<1, 3> &normal, const dealii::Tensor<1, 3> &other);

/// Appends to `shares` the facets that share a node at x which touches `touched`: that one, and, within the
/// zone of its border, those around its nearest corner which meet it smoothly and within whose zones the node
/// is. With their parts s_f, FacetProjection::share made to have the sum 1,
///   n = Σ s_f n_f/|Σ s_f n_f|,   g = Σ s_f g_f/|Σ s_f n_f|
/// which has the gradient n for fixed parts: the gap to the mean of the planes. The result does not jump
/// where the node slides from one facet to the next, nor depend on which of them was chosen, as long as
/// neighbours differ less than twofold in size; its gap may be >= 0, though that of `touched` is not. A node
/// well inside a facet costs nothing.
///
/// Corners and sharp edges are not shared: there the choice decides.
template <class Facet>
SharedGap share_facets(const MovedFacets &facets, const TouchedFacet &touched, const dealii::Tensor<1, 3> &x,
                       const ContactLimits &limits, std::vector<FacetShare> &shares);

} // namespace billet

#endif
