// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/contact_surfaces.h"

#include <algorithm>
#include <utility>

namespace billet {

ContactSurfaces::ContactSurfaces(MPI_Comm communicator, const FacetSearch::Partners partners,
                                 const double margin, std::vector<std::uint64_t> node_keys,
                                 std::vector<SurfaceFacet> facets)
    : communicator_(communicator), partners_(partners), margin_(margin),
      exchange_(communicator, std::move(node_keys), std::move(facets)), search_(partners, margin) {
  for (const auto &facet : exchange_.facets())
    max_reach_ = std::max(max_reach_, facet.reach);
  MPI_Allreduce(MPI_IN_PLACE, &max_reach_, 1, MPI_DOUBLE, MPI_MAX, communicator_);
}

bool ContactSurfaces::update(const Positions &positions_n, const Positions &positions) {
  positions_n_ = positions_n;
  positions_ = positions;
  exchange_.update(positions_n_);
  exchange_.update(positions_);
  const auto over_all_ranks = [this](BoundingBox motion) {
    // One reduction covers both ends of the box: the maximum of −low and of high.
    std::array<double, 6> ends{-motion.low[0], -motion.low[1], -motion.low[2],
                               motion.high[0], motion.high[1], motion.high[2]};
    MPI_Allreduce(MPI_IN_PLACE, ends.data(), 6, MPI_DOUBLE, MPI_MAX, communicator_);
    for (unsigned int i = 0; i < 3; ++i) {
      motion.low[i] = -ends[i];
      motion.high[i] = ends[3 + i];
    }
    return motion;
  };
  is_rebuilt_ = search_.is_outdated(positions_, over_all_ranks);
  if (!is_rebuilt_)
    moved_.reset();
  return is_rebuilt_;
}

double ContactSurfaces::find_distance(const std::optional<double> &penetration) const {
  double distance = max_reach_ + margin_;
  if (!penetration)
    return distance;
  // The middle of an edge or a facet is farther from nodes, and depth is not limited to the reach.
  double longest = 0.;
  for (std::size_t f = 0; f < exchange_.n_own_facets(); ++f) {
    const FacetCorners x = corners_of(exchange_.facets()[f], positions_);
    for (unsigned int i = 0; i < 4; ++i)
      longest = std::max(longest, (x[facet::around[(i + 1) % 4]] - x[facet::around[i]]).norm());
  }
  distance += *penetration * max_reach_ + longest;
  MPI_Allreduce(MPI_IN_PLACE, &distance, 1, MPI_DOUBLE, MPI_MAX, communicator_);
  return distance;
}

void ContactSurfaces::rebuild(const std::vector<SlaveNode> &slaves,
                              const std::optional<double> &penetration) {
  exchange_.rebuild(positions_n_, positions_, find_distance(penetration));
  exchange_.update(positions_n_);
  exchange_.update(positions_);
  search_.set_surface(exchange_.facets(), slaves);
  search_.rebuild(positions_n_, positions_);
  moved_.reset();
  const std::size_t bytes =
      search_.n_candidates() * sizeof(unsigned int) + search_.facets().size() * sizeof(SurfaceFacet);
  memory_.set(bytes);
  if (partners_ == FacetSearch::Partners::other_surfaces_and_self)
    self_memory_.set(bytes);
}

} // namespace billet
