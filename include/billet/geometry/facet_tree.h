// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_FACET_TREE_H
#define BILLET_GEOMETRY_FACET_TREE_H

#include "billet/geometry/box_tree.h"
#include "billet/geometry/triangle_mesh.h"

namespace billet {

/// Search tree of flat triangles for nearest-point queries.
class FacetTree {
public:
  explicit FacetTree(TriangleMesh mesh);

  struct Foot {
    unsigned int facet = 0;
    std::array<double, 3> weights{};                         ///< weights of the facet's corners
    double square = std::numeric_limits<double>::infinity(); ///< square of the distance
  };
  Foot nearest(const dealii::Tensor<1, 3> &x) const;
  /// Calls visit(foot) with the nearest point of each facet whose squared distance from x is at
  /// most `max_square`. Also calls it for some other facets. visit() may lower `max_square`.
  template <class Visit>
  void visit_near(const dealii::Tensor<1, 3> &x, const double &max_square, const Visit &visit) const {
    tree_.visit_near(x, max_square, [&](const unsigned int facet) { visit(nearest_on(facet, x)); });
  }

  const TriangleMesh &mesh() const { return mesh_; }

private:
  Foot nearest_on(unsigned int facet, const dealii::Tensor<1, 3> &x) const;

  TriangleMesh mesh_;
  BoxTree tree_;
};

} // namespace billet

#endif
