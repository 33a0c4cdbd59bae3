// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_FACET_ROTATION_H
#define BILLET_GEOMETRY_FACET_ROTATION_H

#include "billet/geometry/facet_projection.h"

namespace billet {

/// The rotation that a facet's corners made from `from` to `to`: it takes the mean normal (18) onto the mean
/// normal and, about it, turns the corners as near as possible (least squares) to where they are. Exact for
/// a rigid motion by any angle. The identity if either of the two has no area.
///
/// Number: double, or Derivative.
template <class Number>
dealii::Tensor<2, 3, Number> facet_rotation(const FacetCorners &from, const FacetCornersOf<Number> &to);

} // namespace billet

#endif
