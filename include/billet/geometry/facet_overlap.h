// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_FACET_OVERLAP_H
#define BILLET_GEOMETRY_FACET_OVERLAP_H

#include "billet/geometry/facet_bulge.h"

namespace billet {

/// Overlap of a slave facet that has penetrated a target facet, seen along the target's mean normal
/// (18). Members are integrals over the polygon P in which both overlap in the target's plane and
/// the slave is behind, 0 > g >= −depth.
///
/// Each facet is divided into four triangles around the mean of its corners. On these the functions
/// φ_a of the slave's and ψ_I of the target's corners are linear, with the value ¼ in the middle.
/// So all integrands on P are polynomials, integrated exactly; the functions sum to 1, and Σ φ_a
/// x_a is the point itself. The integral of φ_a over a flat facet, however distorted, equals that
/// of the bilinear shape function. A uniform pressure therefore gives both sides the forces of a
/// uniform stress, to round-off.
///
/// Number: double, or Derivative.
template <class Number> struct FacetOverlapOf {
  bool exists = false;
  dealii::Tensor<1, 3, Number> normal;  ///< unit vector, out of the target's body
  std::array<Number, 4> areas{};        ///< ∫ φ_a dA [length²]
  std::array<Number, 4> gaps{};         ///< ∫ φ_a g dA [length³]
  std::array<Number, 4> penetrations{}; ///< ∫ φ_a |g| dA of the lowered slave, >= 0 [length³]
  std::array<std::array<Number, 4>, 4> slave_parts{};  ///< ∫ φ_a φ_b dA, as ...
  std::array<std::array<Number, 4>, 4> target_parts{}; ///< ... ∫ φ_a ψ_I dA [length²]
};

/// Computes the overlap for `penetration` > 0. The polygon and the depths are those of a slave
/// whose corners are lowered by `gap_offsets` and by the multiplier offsets `augmentation`
/// [length]. The gaps do not include `augmentation`. Facets without area, or which do not face each
/// other, do not overlap.
///
/// If heights of the smooth surfaces that the facets approximate are given, the gap is that of
/// these surfaces,
///   g = (x_s − x_t)·n̄ − b_s(ξ_s, η_s) − b_t(ξ_t, η_t),   ξ = Σ φ_a ξ_a                      (C10)
/// with b from (C8). This gap is integrated; the polygon is bounded by the zero of its
/// linearisation about the middle of each piece.
template <class Number>
FacetOverlapOf<Number>
compute_overlap(const FacetCornersOf<Number> &slave, const FacetCornersOf<Number> &target, double penetration,
                const std::array<double, 4> &gap_offsets = {}, const std::array<double, 4> &augmentation = {},
                const FacetBulge &slave_bulge = {}, const FacetBulge &target_bulge = {});

} // namespace billet

#endif
