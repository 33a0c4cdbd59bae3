// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/box_tree.h"

#include <algorithm>
#include <cmath>

namespace billet {

namespace {
constexpr unsigned int leaf_size = 4; // number of boxes
} // namespace

BoxTree::BoxTree(const std::vector<BoundingBox> &boxes) {
  for (unsigned int i = 0; i < boxes.size(); ++i)
    (std::isfinite((boxes[i].high - boxes[i].low).norm()) ? bounded_ : unbounded_).push_back({boxes[i], i});
  if (!bounded_.empty())
    add_node(0, static_cast<unsigned int>(bounded_.size()));
}

void BoxTree::add_node(const unsigned int begin, const unsigned int end) {
  const std::size_t index = nodes_.size();
  nodes_.push_back({BoundingBox::empty(), 0, begin, end});
  BoundingBox middles = BoundingBox::empty();
  for (unsigned int i = begin; i < end; ++i) {
    nodes_[index].box.add(bounded_[i].box);
    middles.add(0.5 * (bounded_[i].box.low + bounded_[i].box.high));
  }
  if (end - begin <= leaf_size)
    return;
  const auto extent = middles.high - middles.low;
  unsigned int axis = 0;
  for (unsigned int i = 1; i < 3; ++i)
    if (extent[i] > extent[axis])
      axis = i;
  const unsigned int half = begin + (end - begin) / 2;
  std::nth_element(bounded_.begin() + begin, bounded_.begin() + half, bounded_.begin() + end,
                   [axis](const Entry &a, const Entry &b) {
                     const double x = a.box.low[axis] + a.box.high[axis],
                                  y = b.box.low[axis] + b.box.high[axis];
                     return x < y || (x == y && a.index < b.index);
                   });
  add_node(begin, half);
  nodes_[index].second = static_cast<unsigned int>(nodes_.size());
  add_node(half, end);
}

} // namespace billet
