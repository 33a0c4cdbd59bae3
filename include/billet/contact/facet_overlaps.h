// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_OVERLAPS_H
#define BILLET_CONTACT_FACET_OVERLAPS_H

#include "billet/contact/facet_search.h"
#include "billet/geometry/facet_overlap.h"

namespace billet {

/// Overlaps between the facets of a search, recomputed for new positions.
class FacetOverlaps {
public:
  using Positions = FacetSearch::Positions;

  /// Maximum penetration of a slave facet behind a target within a step, in reaches of the target.
  /// It allows for a poor first guess. Half of it, or of the wall, is the limit if the facet's
  /// middle was deeper than that at the start of the step. Thus a wall does not stick to its own
  /// far side, nor to the far side of a wall that approaches from the front.
  ///
  /// Facets that are nearly at right angles at the start of the step do not count. The face on
  /// which a box stands touches none of its sides, whose planes it is far behind.
  static constexpr double penetration = 10.;

  /// Lists the pairs that may overlap before positions move by more than `margin` relative to each
  /// other. Slave facets are those of all surfaces if `two_pass`, else of surface 0. Pairs of one
  /// surface count only if `with_self`; they must have no node and no neighbour in common.
  void rebuild(const FacetSearch &search, const Positions &positions_n, const Positions &positions,
               double margin, bool with_self, bool two_pass);

  struct Overlap {
    unsigned int slave, target; ///< facets
    double penetration;         ///< limit of the computation [length]
    FacetOverlapOf<double> integrals;
  };
  /// Computes the overlaps at these positions, with `gap_offsets` and `augmentation` of nodes, if
  /// there are any, as for compute_overlap() [length]. The suffix `_n` marks the start of the step.
  void update(const FacetSearch &search, const Positions &positions_n, const Positions &positions,
              const std::vector<double> &gap_offsets, const std::vector<double> &augmentation);

  /// Calls visit(overlap) for each overlap of a slave facet, by ascending keys of the targets.
  template <class Visit> void visit(const unsigned int slave, const Visit &visit) const {
    for (std::size_t i = first_[slave]; i < first_[slave + 1]; ++i)
      visit(overlaps_[i]);
  }
  /// Calls visit(facet) for all facets near a slave facet which it faces and is not behind at the
  /// start of the step. Others rarely overlap it: the sides of a box, and both faces of a wall, are
  /// near each other.
  template <class Visit>
  void visit_facing(const FacetSearch &search, const Positions &positions_n, const unsigned int slave,
                    const Visit &visit) const {
    for (std::size_t i = first_candidate_[slave]; i < first_candidate_[slave + 1]; ++i)
      if (is_facing(search.facets()[slave], search.facets()[candidates_[i]], positions_n))
        visit(candidates_[i]);
  }

private:
  static bool is_facing(const SurfaceFacet &slave, const SurfaceFacet &target, const Positions &positions_n);

  std::vector<std::size_t> first_candidate_, first_; ///< by slave facet
  std::vector<unsigned int> candidates_;             ///< targets
  std::vector<Overlap> overlaps_;
};

} // namespace billet

#endif
