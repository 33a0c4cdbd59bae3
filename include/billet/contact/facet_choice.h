// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_CHOICE_H
#define BILLET_CONTACT_FACET_CHOICE_H

#include "billet/contact/facet_search.h"

namespace billet {

/// What decides which facet a node touches. Lengths relative to the facet's own.
struct ContactLimits {
  double tolerance = 0.02; ///< of the inside test (20), as FacetLimits::tolerance
  /// A node that touches already is held down to this many times the facet's reach.
  double held_depth = 5.;
  /// A node that touches already and has come to lie below the seam of two facets that meet in a concave
  /// edge, behind both of them and before neither, is held by the one whose border it is less than this far
  /// beyond.
  double seam_tolerance = 0.5;
  /// The normals of node and facet have to make a scalar product less than this one: 0 for surfaces that
  /// must face each other, as of one body; above 1 for all.
  double largest_alignment = 2.;
};

/// The facet that a node touches, if any.
struct TouchedFacet {
  static constexpr unsigned int none = static_cast<unsigned int>(-1);
  unsigned int facet = none;
  FacetProjection projection; ///< its gap is < 0

  bool exists() const { return facet != none; }
};

/// Chooses for a slave node, by index into search.slaves(), the facet that it touches, as a plane
/// (PlanedFacet) or as a bilinear surface (BilinearFacet). `last` is the choice at the step's start,
/// `normals` the unit normals of nodes, or nothing if none are asked for.
///
/// Touched can be a facet that the node is straight above or below, is behind, and faces. A facet that the
/// node has not touched before must have been come through: at the start of the step the node was before it,
/// or behind it by no more than its reach. So a wall is not glued to its own far side, and a fast node is not
/// lost.
///
/// The order of Bittencourt & Creus (1998): the last facet, then those around it, and only for nodes that
/// then touch nothing the candidates. Of several, at one stage, where the middle of one facet lies behind the
/// other's plane (a convex edge, or the two sides of a wall) the one with the shortest way out counts; else,
/// in a concave edge, where the node must get out of both, the one in which it is deeper. Unlike in the
/// paper, this may also replace the last facet, in concave edges only: else a node that slides along one
/// flank would go through the other. One node touches one facet at a time.
template <class Facet>
TouchedFacet choose_facet(const FacetSearch &search, std::size_t slave,
                          const FacetSearch::Positions &positions_n, const FacetSearch::Positions &positions,
                          const FacetSearch::Positions &normals, const TouchedFacet &last,
                          const ContactLimits &limits);

/// Corners of a facet.
inline FacetCorners corners_of(const SurfaceFacet &facet, const FacetSearch::Positions &positions) {
  return {positions[facet.nodes[0]], positions[facet.nodes[1]], positions[facet.nodes[2]],
          positions[facet.nodes[3]]};
}

/// Unit normals of nodes: the mean of the area vectors of the facets around them; 0 where they cancel.
FacetSearch::Positions compute_node_normals(const std::vector<SurfaceFacet> &facets,
                                            const FacetSearch::Positions &positions);

} // namespace billet

#endif
