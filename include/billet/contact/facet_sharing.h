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
  /// With overlaps: the slave's facet, and the weights of its corners at the projected point.
  /// Otherwise the slave node itself is projected.
  unsigned int slave_facet = none;
  std::array<Number, 4> slave_weights{};
  double penetration = 0.; ///< of the overlap
  Number area = 0.;        ///< of the overlap [length²]
};
using FacetShare = FacetShareOf<double>;

/// Normal and gap of a node with respect to all facets that share it.
template <class Number> struct SharedGapOf {
  dealii::Tensor<1, 3, Number> normal; ///< unit
  Number gap;                          ///< [length]
};
using SharedGap = SharedGapOf<double>;

/// Whether facets with these unit normals share a node on their common edge: at less than 60
/// degrees.
bool meet_smoothly(const dealii::Tensor<1, 3> &normal, const dealii::Tensor<1, 3> &other);

/// Returns the part of an overlap that belongs to a corner of the slave facet. Its `share` is the
/// volume ∫ φ_a |g| dA, to which the penalty force is proportional: new contact starts at 0,
/// regardless of its area. Where no penetration exceeds `rounding`, areas count.
template <class Number>
FacetShareOf<Number> share_of_overlap(const FacetOverlapOf<Number> &overlap, const unsigned int corner,
                                      const unsigned int slave_facet, const unsigned int target,
                                      const double penetration, const double rounding) {
  FacetShareOf<Number> result;
  result.facet = target;
  result.area = overlap.areas[corner];
  result.slave_facet = slave_facet;
  result.penetration = penetration;
  result.share = 0.;
  if (!(result.area > 0.))
    return result;
  if (overlap.penetrations[corner] > 0.)
    result.share = overlap.penetrations[corner];
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

/// Returns the effective area A = 1/Σ (s_f²/A_f) of a node with overlaps, from index `first` on,
/// with shares that sum to 1. Then A g = Σ A_f g_f, and a facet that begins to touch does not
/// change A.
template <class Number>
Number effective_area(const std::vector<FacetShareOf<Number>> &shares, const std::size_t first) {
  Number sum = 0.;
  for (std::size_t i = first; i < shares.size(); ++i)
    sum += shares[i].share * shares[i].share / shares[i].area;
  return 1. / sum;
}

/// Combines normals and gaps of facets by their parts s_f. These are the parts of `shares` from
/// index `first` on, which it scales to the sum 1:
///   n = Σ s_f n_f/|Σ s_f n_f|,   g = Σ s_f g_f/|Σ s_f n_f|.
/// For fixed parts, g is the gap to the mean of the planes and has the gradient n.
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

/// Appends to `shares` the facets that share a node at x which touches `touched`. These are that
/// facet and, if the node is within the zone of its edges, others around its nearest corner. The
/// others meet it smoothly, and their zones contain the node. Their parts in combine() are
/// FacetProjection::share.
///
/// The result does not jump where the node slides from one facet to the next. It does not depend on
/// the choice among them, as long as neighbours differ less than twofold in size. Its gap may
/// be >= 0, though that of `touched` is not. A node well inside a facet costs nothing.
///
/// Facets do not share nodes at corners and sharp edges: there the choice decides.
template <class Facet>
SharedGap share_facets(const MovedFacets &facets, const TouchedFacet &touched, const dealii::Tensor<1, 3> &x,
                       const ContactLimits &limits, std::vector<FacetShare> &shares);

} // namespace billet

#endif
