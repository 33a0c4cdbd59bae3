// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_FACET_ROTATION_H
#define BILLET_GEOMETRY_FACET_ROTATION_H

#include "billet/geometry/facet_projection.h"

namespace billet {

/// Returns the rotation of a facet whose corners moved from `from` to `to`. It maps the old mean
/// normal (18) onto the new one; about the normal it fits the corners by least squares. It is exact
/// for rigid motions by any angle, and the identity if either of the two has no area.
///
/// Number: double, or Derivative.
template <class Number>
dealii::Tensor<2, 3, Number> facet_rotation(const FacetCorners &from, const FacetCornersOf<Number> &to);

} // namespace billet

#endif
