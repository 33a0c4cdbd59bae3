// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_BILINEAR_FACET_H
#define BILLET_GEOMETRY_BILINEAR_FACET_H

#include "billet/geometry/facet_projection.h"

namespace billet {

/// A facet as the bilinear surface X(ξ, η) = Σ N_I x_I through its corners: the node's gap is its distance
/// to the closest point, the normal that of the surface there (Bittencourt & Creus 1998, eqs. (10)-(12),
/// for a facet). Its gap has the gradients n at the node and −w_I n at the corners: without friction and at
/// a fixed area, forces by penalty have a potential.
///
/// A node beyond the border projects onto the same surface continued, up to the tolerance; farther out the
/// result is the closest point of the facet itself, on its border, and no projection.
class BilinearFacet {
public:
  explicit BilinearFacet(const facet::Expansion &surface)
      : surface_(surface), has_area_(surface.has_area()) {}

  /// By Newton's method from `start`, the last projection's parameters, or the middle.
  FacetProjection project(const dealii::Tensor<1, 3> &x, const FacetLimits &limits,
                          const std::array<double, 2> &start = {}) const;

  /// The projection that `found` becomes when corners and node move by a little: one more iteration, which
  /// with Derivative as Number gives its exact derivatives.
  template <class Number>
  static FacetProjectionOf<Number> follow(const facet::ExpansionOf<Number> &surface,
                                          const dealii::Tensor<1, 3, Number> &x, const FacetLimits &limits,
                                          const FacetProjection &found);

private:
  /// From the point x = e_0 − arm to that of the surface.
  dealii::Tensor<1, 3> difference(const std::array<double, 2> &at, const dealii::Tensor<1, 3> &arm) const {
    return arm + (at[0] * surface_.e_1 + at[1] * surface_.e_2 + (at[0] * at[1]) * surface_.e_3);
  }
  /// A local minimum of the distance in −range <= ξ, η <= range.
  std::array<double, 2> minimise(const dealii::Tensor<1, 3> &arm, double range,
                                 std::array<double, 2> at) const;
  std::array<double, 2> compute_step(const dealii::Tensor<1, 3> &arm, double range,
                                     const std::array<double, 2> &at) const;
  std::array<double, 2> nearest_on_border(const dealii::Tensor<1, 3> &arm) const;

  facet::Expansion surface_;
  bool has_area_;
};

} // namespace billet

#endif
