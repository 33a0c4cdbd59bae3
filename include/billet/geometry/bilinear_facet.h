// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_BILINEAR_FACET_H
#define BILLET_GEOMETRY_BILINEAR_FACET_H

#include "billet/geometry/facet_projection.h"

namespace billet {

/// Facet as the bilinear surface X(ξ, η) = Σ N_I x_I through its corners. The node's gap is its
/// distance to the closest point. The normal is that of the surface there (Bittencourt & Creus
/// 1998, eqs. (10)-(12), for a facet). The gap has the gradients n at the node and −w_I n at the
/// corners. Hence, without friction and at a fixed area, penalty forces have a potential.
///
/// A node beyond an edge projects onto the extended surface, up to the tolerance. Farther out there
/// is no projection; the result is the closest point on the facet's edges.
class BilinearFacet {
public:
  explicit BilinearFacet(const facet::Expansion &surface)
      : surface_(surface), has_area_(surface.has_area()) {}

  /// Projects x by Newton's method from `start`: the parameters of the last projection, or the
  /// middle.
  FacetProjection project(const dealii::Tensor<1, 3> &x, const FacetLimits &limits,
                          const std::array<double, 2> &start = {}) const;

  /// Returns the projection that `found` becomes after a small motion of corners and node. It makes
  /// one more iteration, which gives exact derivatives if Number is Derivative.
  template <class Number>
  static FacetProjectionOf<Number> follow(const facet::ExpansionOf<Number> &surface,
                                          const dealii::Tensor<1, 3, Number> &x, const FacetLimits &limits,
                                          const FacetProjection &found);

private:
  /// Returns the vector from the point x = e_0 − arm to the point of the surface.
  dealii::Tensor<1, 3> difference(const std::array<double, 2> &at, const dealii::Tensor<1, 3> &arm) const {
    return arm + (at[0] * surface_.e_1 + at[1] * surface_.e_2 + (at[0] * at[1]) * surface_.e_3);
  }
  /// Returns a local minimum of the distance in −range <= ξ, η <= range.
  std::array<double, 2> minimise(const dealii::Tensor<1, 3> &arm, double range,
                                 std::array<double, 2> at) const;
  std::array<double, 2> compute_step(const dealii::Tensor<1, 3> &arm, double range,
                                     const std::array<double, 2> &at) const;
  std::array<double, 2> nearest_on_edge(const dealii::Tensor<1, 3> &arm) const;

  facet::Expansion surface_;
  bool has_area_;
};

} // namespace billet

#endif
