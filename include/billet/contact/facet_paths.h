// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_PATHS_H
#define BILLET_CONTACT_FACET_PATHS_H

#include "billet/contact/surface_exchange.h"

#include <limits>

namespace billet {

/// Checks whether nodes of surfaces go through facets in a motion, slaves or not. It uses the
/// conservative advancement of crossing.h. Each facet is two triangles, all facets form one
/// surface, and all paths are straight.
///
/// A node in front of the nearest facets, or behind them by less than `penetration`, may move
/// freely until it exceeds that depth. Facets that the node is directly behind, and deeper than
/// that, at the start do not count. Those on the other side of its own wall are an example.
class FacetPaths {
public:
  using Positions = FacetSearch::Positions;

  /// Most arguments are as for FacetContact. `penetrations` are the maximum penetrations of nodes
  /// for each of this rank's facets [length]. Contact must find the nodes there, and the wall below
  /// must be more than twice as thick.
  FacetPaths(MPI_Comm communicator, FacetSearch::Partners partners, std::vector<std::uint64_t> node_keys,
             std::vector<SurfaceFacet> facets, std::vector<double> penetrations);

  /// Returns the part of the motion of this rank's nodes during which no node of any rank goes
  /// through a facet. Motions that are small compared with `penetration` are not checked, unless
  /// `is_thorough`. Collective.
  double find_free_part(const Positions &from, const Positions &to, bool is_thorough);

private:
  double find_free_part_of_rank(const Positions &from, const Positions &to, double min_way) const;

  MPI_Comm communicator_;
  FacetSearch::Partners partners_;
  SurfaceExchange exchange_;
  double min_penetration_ = std::numeric_limits<double>::infinity(), max_penetration_ = 0.;
};

} // namespace billet

#endif
