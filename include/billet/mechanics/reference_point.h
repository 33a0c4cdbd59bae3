// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_REFERENCE_POINT_H
#define BILLET_MECHANICS_REFERENCE_POINT_H

#include "billet/mechanics/mean_dilatation.h"

#include <deal.II/base/point.h>

#include <limits>
#include <optional>

namespace billet {

/// Limits of Newton's method for reference coordinates.
struct ReferenceLimits {
  unsigned int max_iterations = 30;
  /// Distance from the centre of the unit cube beyond which the point counts as outside.
  double far = std::numeric_limits<double>::infinity();
};

/// Returns A⁻¹ b; none if A is singular.
std::optional<dealii::Tensor<1, 3>> solve_linear(const dealii::Tensor<2, 3> &A,
                                                 const dealii::Tensor<1, 3> &b);

/// Returns the reference coordinates of a point in the trilinear map of an element with these
/// corners, or in its continuation. Returns none if Newton's method does not find them.
std::optional<dealii::Point<3>> find_reference_point(const ElementVectors &corners,
                                                     const dealii::Tensor<1, 3> &point,
                                                     const ReferenceLimits &limits = {});

} // namespace billet

#endif
