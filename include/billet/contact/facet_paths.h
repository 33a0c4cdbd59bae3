// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_PATHS_H
#define BILLET_CONTACT_FACET_PATHS_H

#include "billet/contact/surface_exchange.h"

#include <limits>

namespace billet {

/// Finds out whether nodes of surfaces go through facets in a motion, whichever of them are slaves: the
/// conservative advancement of crossing.h, with the facets as two triangles each, and all of them, as one
/// surface, in straight lines.
///
/// A node in front of the nearest facets, or less deep behind them than `depth`, may move as it likes until
/// it is deeper than that. Facets that it is straight behind, and deeper, at the start, as those on the other
/// side of its own wall, do not count.
class FacetPaths {
public:
  using Positions = FacetSearch::Positions;

  /// As FacetContact; of each of this rank's facets the depth that nodes must not exceed: contact has to find
  /// them there, and what is below has to be more than twice as thick [length].
  FacetPaths(MPI_Comm communicator, FacetSearch::Partners partners, std::vector<std::uint64_t> node_keys,
             std::vector<SurfaceFacet> facets, std::vector<double> depths);

  /// The part of the motion of this rank's nodes that takes none of any rank through a facet. Motions that
  /// are small against `depth` are let pass, unless `is_thorough`. Collective.
  double find_free_part(const Positions &from, const Positions &to, bool is_thorough);

private:
  double find_free_part_of_rank(const Positions &from, const Positions &to, double least_way) const;

  MPI_Comm communicator_;
  FacetSearch::Partners partners_;
  SurfaceExchange exchange_;
  double least_depth_ = std::numeric_limits<double>::infinity(), largest_depth_ = 0.;
};

} // namespace billet

#endif
