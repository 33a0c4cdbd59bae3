// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_CLOSEST_POINT_H
#define BILLET_GEOMETRY_CLOSEST_POINT_H

#include <deal.II/base/tensor.h>

namespace billet {

/// Returns the point of the triangle a, b, c that is nearest to x; the triangle may have no area.
dealii::Tensor<1, 3> closest_point_of_triangle(const dealii::Tensor<1, 3> &x, const dealii::Tensor<1, 3> &a,
                                               const dealii::Tensor<1, 3> &b, const dealii::Tensor<1, 3> &c);

} // namespace billet

#endif
