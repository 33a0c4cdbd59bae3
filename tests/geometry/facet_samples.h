// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_FACET_SAMPLES_H
#define BILLET_TESTS_FACET_SAMPLES_H

#include "billet/geometry/facet_projection.h"

#include "../testing.h"

namespace billet::testing {

inline dealii::Tensor<1, 3> random_vector(Random &random, const double size) {
  dealii::Tensor<1, 3> v;
  for (unsigned int i = 0; i < 3; ++i)
    v[i] = random(-size, size);
  return v;
}

/// Convex but otherwise of any shape, side lengths about 2 × size, out of plane by up to warp × size, in any
/// place and direction.
inline FacetCorners random_facet(Random &random, const double size, const double warp) {
  const dealii::Tensor<2, 3> R = random.rotation();
  const dealii::Tensor<1, 3> centre = random_vector(random, 5. * size);
  FacetCorners corners;
  for (unsigned int a = 0; a < 4; ++a) {
    dealii::Tensor<1, 3> x;
    for (unsigned int i = 0; i < 2; ++i)
      x[i] = size * (facet::signs[a][i] + random(-0.4, 0.4));
    x[2] = size * random(-warp, warp);
    corners[a] = centre + R * x;
  }
  return corners;
}

} // namespace billet::testing

#endif
