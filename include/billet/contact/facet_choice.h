// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_CHOICE_H
#define BILLET_CONTACT_FACET_CHOICE_H

#include "billet/contact/moved_facets.h"

namespace billet {

/// What decides which facet a node touches. Lengths relative to the facet's own.
struct ContactLimits {
  double tolerance = 0.02; ///< of the inside test (20), as FacetLimits::tolerance
  /// A node so near to an edge, inside or outside, is shared with the facets around it: FacetLimits::zone.
  double zone = 0.1;
  /// A node that touches already is held down to this many times the facet's reach.
  double held_depth = 10.;
  /// A node that touches already and has come to lie below the seam of two facets that meet in a concave
  /// edge, behind both of them and before neither, is held by the one whose border it is less than this far
  /// beyond.
  double seam_tolerance = 0.5;
  /// The normals of node and facet have to make a scalar product less than this one; 1 or more for all. A
  /// little above 0: an edge or a corner whose normal is a mean may touch what is at right angles to it; but
  /// the rim of an end, 0.7, or a corner, 0.58, is no partner of the other body's end that goes on beside it.
  double largest_alignment = 0.2;
};

/// For a projection that may lie so far beyond the border.
inline FacetLimits make_limits(const double tolerance, const ContactLimits &limits) {
  return {tolerance, limits.zone};
}

/// The facet that a node touches, if any.
struct TouchedFacet {
  static constexpr unsigned int none = static_cast<unsigned int>(-1);
  unsigned int facet = none;
  FacetProjection projection; ///< its gap is less than the lift
  /// How deep the node was when it was found behind the facet without having come through it, as one that
  /// comes in from beside: only what is deeper counts. It never grows, and is at most the depth [length].
  double offset = 0.;

  bool exists() const { return facet != none; }
};

/// By how much facets count as raised for a slave node [length].
struct FacetLift {
  double now = 0., at_start = 0.; ///< of the step
};

/// Chooses for a slave node, by index into search.slaves(), the facet that it touches, as a plane
/// (PlanedFacet) or as a bilinear surface (BilinearFacet). `last` is the choice at the step's start.
///
/// Touched can be a facet that the node is straight above or below, is behind, and faces. A facet that the
/// node has not touched before must have been come through: at the start of the step the node was before it,
/// or behind it by no more than its reach. So a wall is not glued to its own far side, and a fast node is not
/// lost. One that was behind it then by more than round-off, in from beside, would be thrown out from the
/// depth: it is touched with an offset.
///
/// The order of Bittencourt & Creus (1998): the last facet, then those around it, and only for nodes that
/// then touch nothing the candidates. Of several, at one stage, where the middle of one facet lies behind the
/// other's plane (a convex edge, or the two sides of a wall) the one with the shortest way out counts; else,
/// in a concave edge, where the node must get out of both, the one in which it is deeper. Unlike in the
/// paper, this may also replace the last facet, in concave edges: else a node that slides along one flank
/// would go through the other; and so may a facet that the node has come through and that faces it far
/// better. Facets that lie nearly in one plane with it need not be looked at.
///
/// Where facets meet smoothly, one is as good as the other: share_facets() makes the contact of both.
///
/// Facets count as raised by `lift`, as the pressure of an augmented Lagrangian wants it, or lowered.
template <class Facet>
TouchedFacet choose_facet(const MovedFacets &facets, std::size_t slave,
                          const FacetSearch::Positions &positions_n, const TouchedFacet &last,
                          const ContactLimits &limits, const FacetLift &lift = {});

/// Only whether the node still touches the facet that it touches in `now`, whatever else is nearer.
template <class Facet>
TouchedFacet keep_facet(const MovedFacets &facets, std::size_t slave,
                        const FacetSearch::Positions &positions_n, const TouchedFacet &now,
                        const ContactLimits &limits, const FacetLift &lift = {});

/// The candidate that a node which touches none is straight above and before, by less than the facet's reach;
/// the nearest, as a plane. Its gap is >= 0. All such facets are candidates, whatever the search's margin.
TouchedFacet find_facet_below(const MovedFacets &facets, std::size_t slave, const ContactLimits &limits);

/// Unit normal of a node: the mean of those of the facets around it, whatever their areas, so that a rim of
/// narrow facets counts; 0 where they cancel, but for round-off, and where there are none.
dealii::Tensor<1, 3> compute_node_normal(const MovedFacets &facets, unsigned int node);

} // namespace billet

#endif
