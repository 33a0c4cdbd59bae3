// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_overlaps.h"

#include "billet/contact/moved_facets.h"
#include "billet/geometry/box_tree.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

namespace {

/// Returns 1 for facets that face each other within 60 degrees, and 0 from 80 degrees on.
double facing_part(const Tensor<1, 3> &area_vector, const Tensor<1, 3> &other) {
  constexpr double minimum = 0.17, enough = 0.5;
  const double cosine = -(area_vector * other) / (area_vector.norm() * other.norm());
  const double z = std::clamp((cosine - minimum) / (enough - minimum), 0., 1.);
  return z * z * (3. - 2. * z);
}

/// Relative position of two facets at the start of a step.
struct StartOfPair {
  double within_step, at_start; ///< limits of penetration [length]
  bool was_behind;
  double facing; ///< from 0 to 1

  StartOfPair(const SurfaceFacet &slave, const SurfaceFacet &target,
              const FacetSearch::Positions &positions_n) {
    const facet::Expansion slave_n = corners_of(slave, positions_n),
                           target_n = corners_of(target, positions_n);
    const Tensor<1, 3> area_vector = target_n.mean_area_vector();
    within_step = FacetOverlaps::penetration * target.reach;
    at_start = 0.5 * std::min(within_step, target.wall);
    was_behind = (slave_n.e_0 - target_n.e_0) * area_vector < -at_start * area_vector.norm();
    facing = facing_part(slave_n.mean_area_vector(), area_vector);
  }
};

} // namespace

bool FacetOverlaps::is_facing(const SurfaceFacet &slave, const SurfaceFacet &target,
                              const Positions &positions_n) {
  const StartOfPair start(slave, target, positions_n);
  return start.facing > 0. && !start.was_behind;
}

void FacetOverlaps::rebuild(const FacetSearch &search, const Positions &positions_n,
                            const Positions &positions, const double margin, const bool with_self,
                            const bool two_pass) {
  const auto &facets = search.facets();
  std::vector<BoundingBox> boxes(facets.size(), BoundingBox::empty());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (const unsigned int node : facets[f].nodes) {
      boxes[f].add(positions_n[node]);
      boxes[f].add(positions[node]);
    }
    boxes[f].enlarge(penetration * facets[f].reach + margin);
  }
  const BoxTree tree(boxes);
  const auto is_neighbour = [&](const unsigned int f, const unsigned int other) {
    bool is_near = f == other;
    for (const unsigned int node : facets[f].nodes)
      search.visit_around(node, [&](const unsigned int beside) {
        for (const unsigned int of_beside : facets[beside].nodes)
          for (const unsigned int of_other : facets[other].nodes)
            is_near = is_near || of_beside == of_other;
      });
    return is_near;
  };
  candidates_.clear();
  first_candidate_.assign(facets.size() + 1, 0);
  for (unsigned int f = 0; f < facets.size(); ++f) {
    first_candidate_[f] = candidates_.size();
    if (!two_pass && facets[f].surface != 0)
      continue;
    const Tensor<1, 3> middle = 0.5 * (boxes[f].low + boxes[f].high);
    const double square = 0.25 * (boxes[f].high - boxes[f].low).norm_square();
    tree.visit_near(middle, square, [&](const unsigned int target) {
      if (!boxes[target].overlaps(boxes[f]))
        return;
      if (facets[target].surface == facets[f].surface && (!with_self || is_neighbour(f, target)))
        return;
      candidates_.push_back(target);
    });
    std::sort(candidates_.begin() + static_cast<std::ptrdiff_t>(first_candidate_[f]), candidates_.end(),
              [&](const unsigned int a, const unsigned int b) { return facets[a].key < facets[b].key; });
  }
  first_candidate_[facets.size()] = candidates_.size();
}

void FacetOverlaps::update(const FacetSearch &search, const Positions &positions_n,
                           const Positions &positions, const std::vector<double> &gap_offsets,
                           const std::vector<double> &augmentation) {
  const auto &facets = search.facets();
  overlaps_.clear();
  first_.assign(facets.size() + 1, 0);
  for (unsigned int f = 0; f < facets.size(); ++f) {
    first_[f] = overlaps_.size();
    if (first_candidate_[f] == first_candidate_[f + 1])
      continue;
    const FacetCorners slave = corners_of(facets[f], positions);
    const std::array<double, 4> gap_offset = corners_of(facets[f], gap_offsets),
                                raise = corners_of(facets[f], augmentation);
    for (std::size_t i = first_candidate_[f]; i < first_candidate_[f + 1]; ++i) {
      const unsigned int target = candidates_[i];
      const StartOfPair start(facets[f], facets[target], positions_n);
      const double limit = start.facing * (start.was_behind ? start.at_start : start.within_step);
      if (!(limit > 0.))
        continue;
      const auto overlap = compute_overlap(slave, corners_of(facets[target], positions), limit, gap_offset,
                                           raise, facets[f].bulge, facets[target].bulge);
      if (overlap.exists)
        overlaps_.push_back({f, target, limit, overlap});
    }
  }
  first_[facets.size()] = overlaps_.size();
}

} // namespace billet
