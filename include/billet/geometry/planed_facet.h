// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_PLANED_FACET_H
#define BILLET_GEOMETRY_PLANED_FACET_H

#include "billet/geometry/facet_projection.h"

namespace billet {

/// Planed contact element (PCE): a facet as the plane through the mean of its corners (Bittencourt & Creus
/// 1998, eqs. (16)-(20)). Needs no iteration.
///
///   n̄ = Σ m_I × p_I/|Σ m_I × p_I| = d_0 × d_1/|d_0 × d_1|                                    (18)
///   ḡ = ¼ Σ (x − x_I)·n̄                                                                    (16)(17)
/// with the edges m_I, p_I that leave corner I, and the diagonals d_0 = x_3 − x_0, d_1 = x_2 − x_1. The
/// projection x − ḡ n̄ is inside if it is on the inner side of each edge, in the plane: that is (20), which
/// asks it of both edges at each corner.
///
/// Weights are the bilinear shape functions at the projection, of the corners as they project onto the
/// plane. Outside (ξ and η at the nearest values in range), and where the corners make no convex
/// quadrilateral, the diagonals take up what is missing: the one weight that gives the projection exactly,
/// w_3 += α, w_0 −= α, w_2 += β, w_1 −= β with α d_0 + β d_1 = x_P − Σ w_I x_I. They may then be negative.
///
/// A facet with two coincident corners is a triangle; one without area has no projection.
class PlanedFacet {
public:
  explicit PlanedFacet(const FacetCorners &corners);

  /// Nothing is searched for, so that a start is of no use.
  FacetProjection project(const dealii::Tensor<1, 3> &x, const FacetLimits &limits,
                          const std::array<double, 2> & /*start*/ = {}) const;

private:
  /// Component along the normal of a × b.
  double cross(const dealii::Tensor<1, 3> &a, const dealii::Tensor<1, 3> &b) const {
    return dealii::cross_product_3d(a, b) * normal_;
  }
  /// Excess and share.
  void locate(const dealii::Tensor<1, 3> &in_plane, double zone, FacetProjection &projection) const;
  std::array<double, 2> compute_parameters(const dealii::Tensor<1, 3> &in_plane) const;

  std::array<dealii::Tensor<1, 3>, 4> corners_; ///< in the plane, from the centre
  dealii::Tensor<1, 3> centre_, normal_;
  std::array<dealii::Tensor<1, 3>, 2> diagonals_;
  double double_area_ = 0.; ///< of the facet as it projects onto the plane; 0 if it has no normal
};

} // namespace billet

#endif
