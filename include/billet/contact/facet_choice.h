// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_CHOICE_H
#define BILLET_CONTACT_FACET_CHOICE_H

#include "billet/contact/moved_facets.h"

namespace billet {

/// Limits that decide which facet a node touches. Lengths are relative to the facet's own.
struct ContactLimits {
  double tolerance = 0.02; ///< of the inside test (20), as FacetLimits::tolerance
  /// Width of the zone along an edge, inside and outside, in which adjacent facets share a node:
  /// FacetLimits::zone.
  double zone = 0.1;
  /// Maximum penetration of a node that touches already, in reaches of the facet.
  double held_penetration = 10.;
  /// Tolerance for a node that touches already and lies below the seam of two facets at a concave
  /// edge, behind both and projecting onto neither. It stays with the facet whose edge it exceeds
  /// by less than this.
  double seam_tolerance = 0.5;
  /// Upper bound of the scalar product of the normals of node and facet; 1 or more accepts all. It
  /// is slightly above 0, since an edge or a corner with a mean normal may touch a facet at right
  /// angles to it. The rim of an end, 0.7, or a corner, 0.58, is no partner of the other body's end
  /// that continues beside it.
  double max_alignment = 0.2;
};

/// Makes the limits of a projection that may lie beyond the facet's edge by `tolerance`.
inline FacetLimits make_limits(const double tolerance, const ContactLimits &limits) {
  return {tolerance, limits.zone};
}

/// The facet that a node touches, if any.
struct TouchedFacet {
  static constexpr unsigned int none = static_cast<unsigned int>(-1);
  unsigned int facet = none;
  FacetProjection projection; ///< its gap is less than the gap offset
  /// Allowed penetration: that of the node when it was found behind the facet without having come
  /// through it, for example from the side. Only the excess counts. It never grows, and is at most
  /// the penetration [length].
  double offset = 0.;

  bool exists() const { return facet != none; }
};

/// Gap offset of a slave node: facets count as raised by this length [length].
struct GapOffset {
  double now = 0., at_start = 0.; ///< of the step
};

/// Chooses the facet that a slave node (index into search.slaves()) touches, as a plane
/// (PlanedFacet) or as a bilinear surface (BilinearFacet). `last` is the choice at the step's
/// start.
///
/// A node can touch a facet if it projects onto it, is behind it, and faces it. It must have come
/// through a facet that it has not touched before. At the start of the step it was then in front of
/// the facet, or behind it by at most its reach. Thus a wall does not stick to its own far side,
/// and a fast node is not lost.
///
/// A node that was behind the facet by more than round-off has come in from the side. It touches
/// the facet with an offset; otherwise it would be ejected.
///
/// The order is that of Bittencourt & Creus (1998): the last facet, then those around it, then the
/// candidates for nodes that still touch nothing. Among several facets at one stage, the one with
/// the least penetration counts at a convex edge, or for the two sides of a wall. There the middle
/// of one facet lies behind the other's plane. Otherwise, at a concave edge, the node must leave
/// both facets, and the one with the larger penetration counts.
///
/// Unlike in the paper, this rule may also replace the last facet at concave edges. Otherwise a
/// node that slides along one flank would go through the other. A facet that the node has come
/// through and that faces it much better may also replace the last one. Facets that are nearly
/// coplanar with the last one need not be checked.
///
/// Where facets meet smoothly, either choice is valid: share_facets() combines them.
///
/// A node that pressed on a facet at the start of the step, `has_pressed`, but has none as its last
/// one, has come through whatever it is behind: the facet's element has been divided.
///
/// Facets count as raised by the gap offset `gap_offset` of the augmented Lagrangian, or as lowered
/// if it is negative.
template <class Facet>
TouchedFacet choose_facet(const MovedFacets &facets, std::size_t slave,
                          const FacetSearch::Positions &positions_n, const TouchedFacet &last,
                          const ContactLimits &limits, const GapOffset &gap_offset = {},
                          bool has_pressed = false);

/// Returns the facet of `now` if the node still touches it, even if another facet is nearer.
template <class Facet>
TouchedFacet keep_facet(const MovedFacets &facets, std::size_t slave,
                        const FacetSearch::Positions &positions_n, const TouchedFacet &now,
                        const ContactLimits &limits, const GapOffset &gap_offset = {});

/// Finds the nearest candidate, as a plane, onto which a node without contact projects from the
/// front at less than the facet's reach. Its gap is >= 0. All such facets are candidates,
/// regardless of the search's margin.
TouchedFacet find_facet_below(const MovedFacets &facets, std::size_t slave, const ContactLimits &limits);

/// Computes the unit normal of a node as the mean of those of the facets around it. It has no area
/// weights, so that a rim of narrow facets counts. Returns 0 where they cancel up to round-off, and
/// where there are none.
dealii::Tensor<1, 3> compute_node_normal(const MovedFacets &facets, unsigned int node);

} // namespace billet

#endif
