// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_FACET_PROJECTION_H
#define BILLET_GEOMETRY_FACET_PROJECTION_H

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <array>
#include <limits>

namespace billet {

/// Corners of a facet at (ξ, η) = (−1, −1), (1, −1), (−1, 1), (1, 1), deal.II's order. The area
/// vector ∂x/∂ξ × ∂x/∂η points out of the body.
template <class Number> using FacetCornersOf = std::array<dealii::Tensor<1, 3, Number>, 4>;
using FacetCorners = FacetCornersOf<double>;

namespace facet {

/// Signs of ξ and η at the corners.
inline constexpr std::array<std::array<double, 2>, 4> signs{{{-1., -1.}, {1., -1.}, {-1., 1.}, {1., 1.}}};

/// Corners in cyclic order around the facet.
inline constexpr std::array<unsigned int, 4> around{0, 1, 3, 2};

/// Returns the bilinear shape functions; their sum is 1 everywhere, and they are >= 0 inside.
template <class Number> std::array<Number, 4> weights(const std::array<Number, 2> &parameters) {
  std::array<Number, 4> w{};
  for (unsigned int a = 0; a < 4; ++a)
    w[a] = 0.25 * (1. + signs[a][0] * parameters[0]) * (1. + signs[a][1] * parameters[1]);
  return w;
}

inline std::array<double, 4> weights(const std::array<double, 2> &parameters) {
  return weights<double>(parameters);
}

/// Distance from the tip of a triangle, relative to its size, within which a point counts as on it.
/// Round-off in the parameters leaves 1e-8 there, where two roots coincide.
inline constexpr double tip = 1e-6;

/// Returns Σ w_I x_I.
template <class Number>
dealii::Tensor<1, 3, Number> interpolate(const std::array<Number, 4> &weights,
                                         const FacetCornersOf<Number> &values) {
  return weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2] + weights[3] * values[3];
}

/// Bilinear surface through the corners, X(ξ, η) = e_0 + ξ e_1 + η e_2 + ξη e_3.
template <class Number> struct ExpansionOf {
  ExpansionOf(const FacetCornersOf<Number> &x) // NOLINT(google-explicit-constructor): the same surface
      : e_0(0.25 * (x[0] + x[1] + x[2] + x[3])), e_1(0.25 * ((x[3] - x[0]) - (x[2] - x[1]))),
        e_2(0.25 * ((x[3] - x[0]) + (x[2] - x[1]))), e_3(0.25 * ((x[0] - x[1]) + (x[3] - x[2]))) {}

  /// Returns the mean of the area vectors ∂X/∂ξ × ∂X/∂η, an eighth of the cross product of the
  /// diagonals.
  dealii::Tensor<1, 3, Number> mean_area_vector() const { return dealii::cross_product_3d(e_1, e_2); }
  /// Returns which parameters are undefined at this point, as at the tip of a triangle, whose two
  /// corners coincide. In the middle they share forces equally between these corners. Anything else
  /// would be decided by round-off.
  std::array<bool, 2> undefined_at(const std::array<double, 2> &at) const {
    const Number no_length = tip * tip * (e_1.norm_square() + e_2.norm_square());
    return {!((e_1 + at[1] * e_3).norm_square() > no_length),
            !((e_2 + at[0] * e_3).norm_square() > no_length)};
  }
  /// Returns the area vector at this point. At the tip of a triangle it vanishes, and beyond it
  /// turns over: there it is the mean.
  dealii::Tensor<1, 3, Number> area_vector(const std::array<Number, 2> &at) const {
    const dealii::Tensor<1, 3, Number> here = dealii::cross_product_3d(e_1 + at[1] * e_3, e_2 + at[0] * e_3),
                                       mean = mean_area_vector();
    return here * mean > tip * mean.norm_square() ? here : mean;
  }
  /// Whether the facet has an area; otherwise it has no normal.
  bool has_area() const {
    // Relative area that round-off of the coordinates may leave for a facet degenerated to a line.
    constexpr double minimum = 1e-12;
    const Number size = 2. * mean_area_vector().norm();
    return size > minimum * (e_1 + e_2).norm_square() && size > minimum * (e_1 - e_2).norm_square();
  }

  dealii::Tensor<1, 3, Number> e_0, e_1, e_2, e_3;
};
using Expansion = ExpansionOf<double>;

/// Returns one edge's factor of FacetProjection::share; `distance` from the edge is positive
/// inside.
template <class Number> Number share_at(const Number &distance, const double zone) {
  const Number share = 0.5 * (distance / zone + 1.), positive = share > 0. ? share : Number(0.);
  // So written it is continuous; a jump would disturb nodes on a seam.
  return positive < 1. ? positive : Number(1.);
}

} // namespace facet

/// Limits of the distance from a facet within which a node belongs to it.
struct FacetLimits {
  /// Maximum distance of the projection beyond an edge, relative to the facet's extent across that
  /// edge. It prevents the loss of nodes in the seam of two facets whose planes, or normals, do not
  /// match.
  double tolerance = 0.02;
  /// Distance from an edge, on both sides and relative to the same extent, within which facets
  /// share a node; > 0.
  double zone = 0.1;
};

/// Projection of a node x in front of a facet or behind it.
template <class Number> struct FacetProjectionOf {
  /// Whether the node is directly above or below the facet, within its limits. Otherwise the
  /// weights may be unset; if the facet has no area, everything is unset.
  bool exists = false;
  dealii::Tensor<1, 3, Number> normal; ///< unit vector, out of the body
  /// Gap along the normal, negative where the node has penetrated [length].
  Number gap = 0.;
  /// Weights of the facet's corners; their sum is 1. If `exists`, x − Σ w_I x_I is parallel to the
  /// normal. A normal force at x and −w_I times that force at the corners then balance, and so do
  /// their moments.
  std::array<Number, 4> weights{};
  std::array<Number, 2> parameters{}; ///< (ξ, η), where a search for the next projection starts
  /// Distance of the projection beyond the edges, in the measure of FacetLimits::tolerance; 0
  /// inside.
  double excess = std::numeric_limits<double>::infinity();
  /// Share of the facet, not normalised, in a node that adjacent facets share. It is the product
  /// over its edges of (distance + zone)/(2 zone), clipped to [0, 1]. It is 1 well inside; on a
  /// regular grid the shares sum to 1.
  Number share = 0.;
};
using FacetProjection = FacetProjectionOf<double>;

} // namespace billet

#endif
