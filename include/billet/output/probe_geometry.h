// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_PROBE_GEOMETRY_H
#define BILLET_OUTPUT_PROBE_GEOMETRY_H

#include <deal.II/base/tensor.h>

#include <array>
#include <optional>

namespace billet {

/// Corners of a facet, in the order of BoundaryFacet.
using FacetCorners = std::array<dealii::Tensor<1, 3>, 4>;

/// Returns the point of the facet with these coordinates from 0 to 1.
dealii::Tensor<1, 3> point_of_facet(const FacetCorners &corners, const std::array<double, 2> &at);

/// Returns the unit normal of the facet there, ∂x/∂ξ × ∂x/∂η. Zero if the facet has none.
dealii::Tensor<1, 3> normal_of_facet(const FacetCorners &corners, const std::array<double, 2> &at);

/// Point at which a line meets a facet, or its continuation.
struct FacetCrossing {
  std::array<double, 2> at; ///< coordinates, from 0 to 1 on the facet
  double distance;          ///< along the line [length]

  bool is_on_facet() const;
};

/// Returns where the line through x along the unit vector d meets the bilinear continuation of the
/// facet. Returns none if Newton's method does not find it.
std::optional<FacetCrossing> cross_facet(const FacetCorners &corners, const dealii::Tensor<1, 3> &x,
                                         const dealii::Tensor<1, 3> &d);

} // namespace billet

#endif
