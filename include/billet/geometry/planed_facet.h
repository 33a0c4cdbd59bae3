// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_PLANED_FACET_H
#define BILLET_GEOMETRY_PLANED_FACET_H

#include "billet/geometry/facet_projection.h"

#include <cmath>

namespace billet {

/// Planed contact element (PCE): facet as the plane through the mean of its corners (Bittencourt &
/// Creus 1998, eqs. (16)-(20)). Projections need no iteration.
///
///   n̄ = Σ m_I × p_I/|Σ m_I × p_I| = d_0 × d_1/|d_0 × d_1|                                    (18)
///   ḡ = ¼ Σ (x − x_I)·n̄                                                                  (16)(17)
/// with the edges m_I, p_I that leave corner I, and the diagonals d_0 = x_3 − x_0, d_1 = x_2 − x_1.
/// The projection x − ḡ n̄ is inside if it is on the inner side of each edge, in the plane. This is
/// (20), which requires it of both edges at each corner.
///
/// The gap is not the mean gap but that to the warped surface above the same projection,
///   g = (x − Σ w_I x_I)·n̄ = ḡ − h Σ ±w_I                                                     (C1)
/// with the corners ±h from the plane. Then ∂g/∂x_I = −w_I n̄ to first order in the warp,
/// consistent with the reaction, and neighbours agree on their common edge. The mean gap ignores
/// the warping that its reaction drives, and can generate energy: see MeanGapFacet.
///
/// Weights are the bilinear shape functions at the projection, for the corners projected onto the
/// plane. Outside, ξ and η have the nearest values in range. There, and where the corners form no
/// convex quadrilateral, the diagonals correct the weights so that they reproduce the projection
/// exactly. The corrections are w_3 += α, w_0 −= α, w_2 += β, w_1 −= β with α d_0 + β d_1 = x_P − Σ
/// w_I x_I. They may then be negative.
///
/// A facet with two coincident corners is a triangle; one without area has no projection.
///
/// Number: double, or Derivative for derivatives with respect to the corners and the node.
template <class Number> class PlanedFacetOf {
public:
  using Vector = dealii::Tensor<1, 3, Number>;
  explicit PlanedFacetOf(const facet::ExpansionOf<Number> &surface);

  /// Returns the mean of the corners.
  const Vector &centre() const { return centre_; }
  /// Returns the unit normal, out of the body; 0 if the facet has no area.
  const Vector &normal() const { return normal_; }

  /// Returns the radius of a circle around the corners [length].
  double radius() const { return std::sqrt(square_of_radius_); }

  /// Whether the whole surface between the corners, however warped and extended by `tolerance`
  /// beyond its edges, is behind the point. This check is cheaper than a projection, as is
  /// is_aside().
  bool is_before(const Vector &x, const double tolerance) const {
    return (x - centre_) * normal_ > std::abs(warp_) * (1. + 2. * tolerance) * (1. + 2. * tolerance);
  }
  /// Whether the point is neither above nor below that surface nor within `tolerance` of its edges,
  /// for any direction of its normals.
  bool is_aside(const Vector &x, double tolerance) const;

  /// Returns the projection; `start` is unused, since there is no iteration.
  FacetProjectionOf<Number> project(const Vector &x, const FacetLimits &limits,
                                    const std::array<double, 2> & /*start*/ = {}) const {
    return project(x, limits, warp_);
  }
  /// Returns the projection with the gap ḡ.
  FacetProjectionOf<Number> project_to_mean_plane(const Vector &x, const FacetLimits &limits) const {
    return project(x, limits, Number(0.));
  }

private:
  /// Components along two unit vectors in the plane, relative to the centre.
  using InPlane = std::array<Number, 2>;

  static Number cross(const InPlane &a, const InPlane &b) { return a[0] * b[1] - a[1] * b[0]; }
  /// Returns ξ e_1 + η e_2 + ξη e_3.
  InPlane at(const Number &xi, const Number &eta) const {
    return {xi * e_1_[0] + eta * e_2_[0] + xi * eta * e_3_[0],
            xi * e_1_[1] + eta * e_2_[1] + xi * eta * e_3_[1]};
  }
  /// Projects x; `warp` is the assumed height of corners 0 and 3 above the plane, and of the others
  /// below it [length].
  FacetProjectionOf<Number> project(const Vector &x, const FacetLimits &limits, const Number &warp) const;
  /// Computes excess and share of the projection.
  void locate(const InPlane &x, double zone, FacetProjectionOf<Number> &projection) const;
  std::array<Number, 2> compute_parameters(const InPlane &x) const;

  /// Distance from an edge, relative to the facet's extent across it, is along·x + offset; positive
  /// inside.
  struct Border {
    InPlane along;
    Number offset;
  };

  Vector centre_, normal_;
  std::array<Vector, 2> directions_; ///< normal to each other and to the normal
  InPlane e_1_{}, e_2_{}, e_3_{};    ///< expansion of the corners projected onto the plane
  Number double_area_ = 0.;          ///< twice their area; 0 if the facet has no normal
  Number warp_ = 0.;                 ///< height of corners 0 and 3
  double square_of_radius_ = 0.;
  std::array<Border, 4> borders_{};
};
using PlanedFacet = PlanedFacetOf<double>;

/// Planed contact element as published: the gap is ḡ, the weights are those of the bilinear
/// surface. If nodes of both sides lie on the same seams of a curved surface, it can feed energy
/// into the warping of facets. In one test case the energy grows by a factor e every 5 µs until the
/// run stops.
template <class Number> class MeanGapFacetOf : public PlanedFacetOf<Number> {
public:
  using PlanedFacetOf<Number>::PlanedFacetOf;
  FacetProjectionOf<Number> project(const dealii::Tensor<1, 3, Number> &x, const FacetLimits &limits,
                                    const std::array<double, 2> & /*start*/ = {}) const {
    return this->project_to_mean_plane(x, limits);
  }
};
using MeanGapFacet = MeanGapFacetOf<double>;

} // namespace billet

#endif
