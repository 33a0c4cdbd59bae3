// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_OVERLAPS_H
#define BILLET_CONTACT_FACET_OVERLAPS_H

#include "billet/contact/facet_search.h"
#include "billet/geometry/facet_overlap.h"

namespace billet {

/// The overlaps of the facets of a search with each other, made anew for new positions.
class FacetOverlaps {
public:
  using Positions = FacetSearch::Positions;

  /// Up to so many times a target's reach a slave facet may be behind it within a step, so that it is not
  /// lost by a first guess that is far off. If its middle was behind it already when the step began, by more
  /// than half of that or of the wall: up to that. So a wall is not glued to its own far side, nor to the far
  /// side of what comes near it from the front. Facets that are nearly at right angles when the step begins
  /// do not count: the face on which a box stands touches none of its sides, whose planes it is far behind.
  static constexpr double depth = 10.;

  /// Lists the pairs that may come to overlap before positions move by more than `margin` relative to each
  /// other, for slave facets of surfaces for which `is_slave`. Pairs of one surface, which have to have no
  /// node in common and no neighbour, only `with_self`.
  void rebuild(const FacetSearch &search, const Positions &positions_n, const Positions &positions,
               double margin, bool with_self, bool two_pass);

  struct Overlap {
    unsigned int slave, target; ///< facets
    double depth;               ///< with which it was computed
    FacetOverlapOf<double> integrals;
  };
  /// Overlaps at these positions, with `lifts` and `augmentation` of nodes, if there are any, as
  /// compute_overlap() wants them [length]; `_n` as at the start of the step.
  void update(const FacetSearch &search, const Positions &positions_n, const Positions &positions,
              const std::vector<double> &lifts, const std::vector<double> &augmentation);

  /// Calls visit(overlap) for those of a slave facet, by rising keys of the targets.
  template <class Visit> void visit(const unsigned int slave, const Visit &visit) const {
    for (std::size_t i = first_[slave]; i < first_[slave + 1]; ++i)
      visit(overlaps_[i]);
  }
  /// Calls visit(facet) for all that may come to overlap a slave facet.
  template <class Visit> void visit_candidates(const unsigned int slave, const Visit &visit) const {
    for (std::size_t i = first_candidate_[slave]; i < first_candidate_[slave + 1]; ++i)
      visit(candidates_[i]);
  }

private:
  std::vector<std::size_t> first_candidate_, first_; ///< by slave facet
  std::vector<unsigned int> candidates_;             ///< targets
  std::vector<Overlap> overlaps_;
};

} // namespace billet

#endif
