// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_BOX_TREE_H
#define BILLET_GEOMETRY_BOX_TREE_H

#include "billet/geometry/surface_patch.h"

#include <array>
#include <vector>

namespace billet {

/// Binary tree of boxes, split along their longest extent, for searches near a point.
class BoxTree {
public:
  /// Boxes with infinite sides are kept outside the tree.
  explicit BoxTree(const std::vector<BoundingBox> &boxes);

  /// Calls visit(index) for the boxes whose squared distance from x is at most `max_square`, near
  /// ones first. visit() may lower `max_square`.
  template <class Visit>
  void visit_near(const dealii::Tensor<1, 3> &x, const double &max_square, const Visit &visit) const {
    for (const Entry &entry : unbounded_)
      if (entry.box.distance_square(x) <= max_square)
        visit(entry.index);
    struct Candidate {
      unsigned int node;
      double square;
    };
    std::array<Candidate, 64> stack; // one entry per level
    unsigned int n = 0;
    if (!nodes_.empty())
      stack[n++] = {0, nodes_[0].box.distance_square(x)};
    while (n > 0) {
      const Candidate candidate = stack[--n];
      if (candidate.square > max_square)
        continue;
      const Node &node = nodes_[candidate.node];
      if (node.second == 0) {
        for (unsigned int i = node.begin; i < node.end; ++i)
          if (bounded_[i].box.distance_square(x) <= max_square)
            visit(bounded_[i].index);
        continue;
      }
      const unsigned int first = candidate.node + 1;
      Candidate near{first, nodes_[first].box.distance_square(x)};
      Candidate far{node.second, nodes_[node.second].box.distance_square(x)};
      if (far.square < near.square)
        std::swap(near, far);
      stack[n++] = far;
      stack[n++] = near;
    }
  }

private:
  struct Entry {
    BoundingBox box;
    unsigned int index;
  };
  /// Node of the tree; its first child follows it.
  struct Node {
    BoundingBox box;
    unsigned int second;     ///< second child; 0 for a leaf
    unsigned int begin, end; ///< range of a leaf's boxes
  };
  void add_node(unsigned int begin, unsigned int end);

  std::vector<Entry> unbounded_;
  std::vector<Entry> bounded_; ///< leaf by leaf
  std::vector<Node> nodes_;
};

} // namespace billet

#endif
