// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_MOVED_FACETS_H
#define BILLET_CONTACT_MOVED_FACETS_H

#include "billet/contact/facet_areas.h"
#include "billet/contact/facet_reaction.h"
#include "billet/contact/facet_search.h"
#include "billet/geometry/planed_facet.h"

#include <deque>
#include <optional>
#include <type_traits>
#include <vector>

namespace billet {

/// Returns the corners of a facet.
inline FacetCorners corners_of(const SurfaceFacet &facet, const FacetSearch::Positions &positions) {
  return {positions[facet.nodes[0]], positions[facet.nodes[1]], positions[facet.nodes[2]],
          positions[facet.nodes[3]]};
}

/// Returns the values at a facet's corners of `numbers` of all nodes; zeros if these are empty.
inline std::array<double, 4> corners_of(const SurfaceFacet &facet, const std::vector<double> &numbers) {
  if (numbers.empty())
    return {};
  return {numbers[facet.nodes[0]], numbers[facet.nodes[1]], numbers[facet.nodes[2]], numbers[facet.nodes[3]]};
}

/// Facets of a search at the current positions of their nodes. The data of a facet is computed on
/// first use and cached. Several nodes use the same facet, and few facets of a large surface are
/// used.
class MovedFacets {
public:
  using Positions = FacetSearch::Positions;

  /// Both must outlive this object, at the same address.
  MovedFacets(const FacetSearch &search, const Positions &positions)
      : search_(search), positions_(positions) {
    reset();
  }

  /// Clears the cache; must be called when nodes have moved or facets have changed.
  void reset() {
    index_.assign(search_.facets().size(), none);
    n_kept_ = 0;
  }

  const FacetSearch &search() const { return search_; }
  const dealii::Tensor<1, 3> &position(const unsigned int node) const { return positions_[node]; }
  FacetCorners corners(const unsigned int facet) const {
    return corners_of(search_.facets()[facet], positions_);
  }

  const PlanedFacet &plane(const unsigned int facet) const { return get(facet).plane; }
  const FacetAreas &areas(const unsigned int facet) const { return get(facet).areas; }
  /// Returns the reaction, which is computed only for the few facets under pressure.
  const FacetReaction &reaction(const unsigned int facet) const {
    const Kept &kept = get(facet);
    if (!kept.reaction)
      kept.reaction.emplace(facet::Expansion(corners(facet)));
    return *kept.reaction;
  }

  /// Returns the projection of x onto a facet of type Facet: PlanedFacet, MeanGapFacet or
  /// BilinearFacet.
  template <class Facet>
  FacetProjection project(const unsigned int facet, const dealii::Tensor<1, 3> &x, const FacetLimits &limits,
                          const std::array<double, 2> &start = {}) const {
    return raised(project_flat<Facet>(facet, x, limits, start), search_.facets()[facet]);
  }

private:
  template <class Facet>
  FacetProjection project_flat(const unsigned int facet, const dealii::Tensor<1, 3> &x,
                               const FacetLimits &limits, const std::array<double, 2> &start) const {
    if constexpr (std::is_same_v<Facet, PlanedFacet>)
      return plane(facet).project(x, limits);
    else if constexpr (std::is_same_v<Facet, MeanGapFacet>)
      return plane(facet).project_to_mean_plane(x, limits);
    else
      return Facet(corners(facet)).project(x, limits, start);
  }

  struct Kept {
    explicit Kept(const facet::Expansion &surface) : plane(surface), areas(surface) {}
    PlanedFacet plane;
    FacetAreas areas;
    mutable std::optional<FacetReaction> reaction;
  };

  const Kept &get(const unsigned int facet) const {
    if (index_[facet] == none) {
      if (n_kept_ == kept_.size())
        kept_.emplace_back();
      kept_[n_kept_].emplace(corners(facet));
      index_[facet] = n_kept_++;
    }
    return *kept_[index_[facet]];
  }

  static constexpr unsigned int none = static_cast<unsigned int>(-1);

  const FacetSearch &search_;
  const Positions &positions_;
  mutable std::vector<unsigned int> index_; ///< in kept_, by facet
  mutable std::deque<std::optional<Kept>>
      kept_; ///< references stay valid while it grows; memory is kept from step to step
  mutable unsigned int n_kept_ = 0;
};

} // namespace billet

#endif
