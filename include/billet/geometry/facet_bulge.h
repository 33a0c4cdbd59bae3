// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_FACET_BULGE_H
#define BILLET_GEOMETRY_FACET_BULGE_H

#include "billet/geometry/facet_projection.h"

namespace billet {

/// Heights of a smooth surface above the middles of a facet's edges, outwards, in the order of
/// facet::around [length]. The surface goes through the corners.
using FacetBulge = std::array<double, 4>;

namespace facet {

/// Returns the height of that surface above the point (ξ, η) of the facet. The eight-node function
/// is exact for heights quadratic in ξ and η, except ξ²η²,
///   b(ξ, η) = ½ (1 − ξ²) [(1 − η) b_0 + (1 + η) b_2]
///             + ½ (1 − η²) [(1 + ξ) b_1 + (1 − ξ) b_3].                                       (C8)
template <class Number> Number height(const FacetBulge &bulge, const std::array<Number, 2> &parameters) {
  const Number &xi = parameters[0], &eta = parameters[1];
  return 0.5 * (1. - xi * xi) * ((1. - eta) * bulge[0] + (1. + eta) * bulge[2]) +
         0.5 * (1. - eta * eta) * ((1. + xi) * bulge[1] + (1. - xi) * bulge[3]);
}

/// Returns the derivatives of height() by ξ and η.
template <class Number>
std::array<Number, 2> height_gradient(const FacetBulge &bulge, const std::array<Number, 2> &parameters) {
  const Number &xi = parameters[0], &eta = parameters[1];
  return {
      -xi * ((1. - eta) * bulge[0] + (1. + eta) * bulge[2]) + 0.5 * (1. - eta * eta) * (bulge[1] - bulge[3]),
      -eta * ((1. + xi) * bulge[1] + (1. - xi) * bulge[3]) + 0.5 * (1. - xi * xi) * (bulge[2] - bulge[0])};
}

/// Whether the surface differs from the facet.
inline bool has_height(const FacetBulge &bulge) {
  return bulge[0] != 0. || bulge[1] != 0. || bulge[2] != 0. || bulge[3] != 0.;
}

/// Returns an upper bound of the height.
inline double max_height(const FacetBulge &bulge) {
  return std::max({bulge[0], bulge[2], 0.}) + std::max({bulge[1], bulge[3], 0.});
}

/// Computes the heights from the unit normals of the smooth surface at the corners. Let a
/// curve from x_a to x_b be normal to n_a and n_b at its ends. To second order in its angle, it
/// rises above the middle of its chord to
///   b = (n_b − n_a)·(x_b − x_a)/8.                                                            (C9)
/// This is L²/(8 R) for a circle.
inline FacetBulge bulge_from_normals(const FacetCorners &corners, const FacetCorners &normals) {
  FacetBulge bulge{};
  for (unsigned int i = 0; i < 4; ++i) {
    const unsigned int a = around[i], b = around[(i + 1) % 4];
    bulge[i] = (normals[b] - normals[a]) * (corners[b] - corners[a]) / 8.;
  }
  return bulge;
}

} // namespace facet

} // namespace billet

#endif
