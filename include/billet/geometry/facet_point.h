// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_FACET_POINT_H
#define BILLET_GEOMETRY_FACET_POINT_H

#include <deal.II/base/tensor.h>

#include <array>

namespace billet {

/// Shape functions and their derivatives at one of the four Gauss points of a facet, (±1/√3, ±1/√3)
/// with weights 1.
struct FacetPoint {
  std::array<double, 4> N, N_xi, N_eta;

  /// Returns ∂x/∂ξ and ∂x/∂η; position(a) is the position of corner a.
  template <class Position> std::array<dealii::Tensor<1, 3>, 2> tangents(const Position &position) const {
    std::array<dealii::Tensor<1, 3>, 2> g;
    for (unsigned int a = 0; a < 4; ++a) {
      g[0] += N_xi[a] * position(a);
      g[1] += N_eta[a] * position(a);
    }
    return g;
  }
  /// Returns the cross product of the tangents.
  template <class Position> dealii::Tensor<1, 3> area_vector(const Position &position) const {
    const auto g = tangents(position);
    return dealii::cross_product_3d(g[0], g[1]);
  }
};
const std::array<FacetPoint, 4> &facet_points();

} // namespace billet

#endif
