// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_SHARING_H
#define BILLET_CONTACT_FACET_SHARING_H

#include "billet/contact/facet_choice.h"
#include "billet/geometry/facet_overlap.h"

namespace billet {

/// A facet's part in the contact of a node.
template <class Number> struct FacetShareOf {
  static constexpr unsigned int none = static_cast<unsigned int>(-1);

  unsigned int facet;
  Number share; ///< >= 0; their sum is 1
  FacetProjectionOf<Number> projection;
  /// Where facets touch as a whole: the slave's, and the weights of its corners in what is projected. Else
  /// the slave node itself is.
  unsigned int slave_facet = none;
  std::array<Number, 4> slave_weights{};
  double depth = 0.; ///< of the overlap
  Number area = 0.;  ///< of the overlap [length²]
};
using FacetShare = FacetShareOf<double>;

/// Normal and gap of a node with all facets that share it.
template <class Number> struct SharedGapOf {
  dealii::Tensor<1, 3, Number> normal; ///< unit
  Number gap;                          ///< [length]
};
using SharedGap = SharedGapOf<double>;

/// Whether facets with these unit normals share a node on their border: at less than 60 degrees.
bool meet_smoothly(const dealii::Tensor<1, 3> &normal, const dealii::Tensor<1, 3> &other);

/// The part of an overlap that belongs to a corner of the slave facet, with the volume ∫ φ_a |g| dA, which a
/// penalty makes the force of, as its `share`: what begins to touch begins without, however large it is.
/// Where nothing is deeper than `rounding`, areas count.
template <class Number>
FacetShareOf<Number> share_of_overlap(const FacetOverlapOf<Number> &overlap, const unsigned int corner,
                                      const unsigned int slave_facet, const unsigned int target,
                                      const double depth, const double rounding) {
  FacetShareOf<Number> result;
  result.facet = target;
  result.area = overlap.areas[corner];
  result.slave_facet = slave_facet;
  result.depth = depth;
  result.share = 0.;
  if (!(result.area > 0.))
    return result;
  if (overlap.depths[corner] > 0.)
    result.share = overlap.depths[corner];
  result.share += rounding * result.area;
  result.projection.exists = true;
  result.projection.normal = overlap.normal;
  result.projection.gap = overlap.gaps[corner] / result.area;
  for (unsigned int i = 0; i < 4; ++i) {
    result.slave_weights[i] = overlap.slave_parts[corner][i] / result.area;
    result.projection.weights[i] = overlap.target_parts[corner][i] / result.area;
  }
  return result;
}

/// The area A = 1/Σ (s_f²/A_f) with which a node that touches by overlaps counts, from index `first` on,
/// their shares having the sum 1: A g is then Σ A_f g_f, and a facet that begins to touch does not change A.
template <class Number>
Number effective_area(const std::vector<FacetShareOf<Number>> &shares, const std::size_t first) {
  Number sum = 0.;
  for (std::size_t i = first; i < shares.size(); ++i)
    sum += shares[i].share * shares[i].share / shares[i].area;
  return 1. / sum;
}

/// With the parts s_f of facets, those of `shares` from index `first` on, which are made to have the sum 1,
///   n = Σ s_f n_f/|Σ s_f n_f|,   g = Σ s_f g_f/|Σ s_f n_f|
/// which has the gradient n for fixed parts: the gap to the mean of the planes.
template <class Number>
SharedGapOf<Number> combine(std::vector<FacetShareOf<Number>> &shares, const std::size_t first) {
  Number sum = 0.;
  for (std::size_t i = first; i < shares.size(); ++i)
    sum += shares[i].share;
  SharedGapOf<Number> result{dealii::Tensor<1, 3, Number>(), 0.};
  for (std::size_t i = first; i < shares.size(); ++i) {
    shares[i].share /= sum;
    result.normal += shares[i].share * shares[i].projection.normal;
    result.gap += shares[i].share * shares[i].projection.gap;
  }
  const Number length = result.normal.norm();
  result.normal /= length;
  result.gap /= length;
  return result;
}

/// Appends to `shares` the facets that share a node at x which touches `touched`: that one, and, within the
/// zone of its border, those around its nearest corner which meet it smoothly and within whose zones the node
/// is. Their parts in combine() are FacetProjection::share. The result does not jump
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
