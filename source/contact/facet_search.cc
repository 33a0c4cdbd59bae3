// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_search.h"

#include "billet/geometry/box_tree.h"

#include <deal.II/base/exceptions.h>

#include <algorithm>

namespace billet {

using dealii::Tensor;

FacetSearch::FacetSearch(const Partners partners, const double margin)
    : partners_(partners), margin_(margin) {
  Assert(margin > 0., dealii::ExcMessage("Without a margin, lists would be made anew at every step."));
}

void FacetSearch::set_surface(std::vector<SurfaceFacet> facets, std::vector<SlaveNode> slaves) {
  facets_ = std::move(facets);
  slaves_ = std::move(slaves);
  std::size_t n_nodes = 0;
  for (const auto &facet : facets_)
    for (const unsigned int node : facet.nodes)
      n_nodes = std::max<std::size_t>(n_nodes, node + 1);
  for (const auto &slave : slaves_)
    n_nodes = std::max<std::size_t>(n_nodes, slave.node + 1);

  // Facets around each node: count, then fill from the back.
  first_around_.assign(n_nodes + 1, 0);
  for (const auto &facet : facets_)
    for (const unsigned int node : facet.nodes)
      ++first_around_[node];
  for (std::size_t i = 1; i <= n_nodes; ++i)
    first_around_[i] += first_around_[i - 1];
  around_.resize(first_around_[n_nodes]);
  for (std::size_t f = facets_.size(); f-- > 0;)
    for (const unsigned int node : facets_[f].nodes)
      around_[--first_around_[node]] = static_cast<unsigned int>(f);
  const auto by_key = [&](const unsigned int a, const unsigned int b) {
    return facets_[a].key < facets_[b].key;
  };
  const auto begin = [&](const std::size_t i) {
    return around_.begin() + static_cast<std::ptrdiff_t>(first_around_[i]);
  };
  for (std::size_t i = 0; i < n_nodes; ++i)
    std::sort(begin(i), begin(i + 1), by_key);
  built_at_.clear();
  has_lists_ = false;
  candidates_.clear();
  first_candidate_.assign(slaves_.size() + 1, 0);
}

BoundingBox FacetSearch::compute_motion(const Positions &positions) const {
  BoundingBox motion = BoundingBox::empty();
  for (std::size_t i = 0; i < built_at_.size(); ++i)
    motion.add(positions[i] - built_at_[i]);
  return motion;
}

bool FacetSearch::exceeds_margin(const BoundingBox &motion) const {
  return !((motion.high - motion.low).norm() <= margin_) && motion.low[0] <= motion.high[0];
}

bool FacetSearch::is_excluded(const SlaveNode &slave, const SurfaceFacet &facet) const {
  if (slave.surface != facet.surface)
    return false;
  if (partners_ == Partners::other_surfaces)
    return true;
  for (std::size_t i = first_around_[slave.node]; i < first_around_[slave.node + 1]; ++i)
    for (const unsigned int node : facets_[around_[i]].nodes)
      if (has_node(facet, node))
        return true;
  return false;
}

void FacetSearch::rebuild(const Positions &positions_n, const Positions &positions) {
  std::vector<BoundingBox> boxes(facets_.size(), BoundingBox::empty());
  for (std::size_t f = 0; f < facets_.size(); ++f) {
    for (const unsigned int node : facets_[f].nodes) {
      boxes[f].add(positions_n[node]);
      boxes[f].add(positions[node]);
    }
    boxes[f].enlarge(facets_[f].reach + margin_);
  }
  const BoxTree tree(boxes);
  candidates_.clear();
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const SlaveNode &slave = slaves_[s];
    BoundingBox way = BoundingBox::empty();
    way.add(positions_n[slave.node]);
    way.add(positions[slave.node]);
    // The tree searches spheres only: this one surrounds the path.
    const Tensor<1, 3> middle = 0.5 * (positions_n[slave.node] + positions[slave.node]);
    const double square = 0.25 * (positions[slave.node] - positions_n[slave.node]).norm_square();
    first_candidate_[s] = candidates_.size();
    tree.visit_near(middle, square, [&](const unsigned int facet) {
      if (boxes[facet].overlaps(way) && !is_excluded(slave, facets_[facet]))
        candidates_.push_back(facet);
    });
    std::sort(candidates_.begin() + static_cast<std::ptrdiff_t>(first_candidate_[s]), candidates_.end(),
              [&](const unsigned int a, const unsigned int b) { return facets_[a].key < facets_[b].key; });
  }
  first_candidate_[slaves_.size()] = candidates_.size();
  built_at_ = positions;
  has_lists_ = true;
  ++n_rebuilds_;
}

} // namespace billet
