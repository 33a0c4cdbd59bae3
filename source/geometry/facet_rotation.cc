// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/facet_rotation.h"

#include "billet/geometry/frame.h"

#include <deal.II/base/symmetric_tensor.h>

#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

/// Rows q, r, n: any frame about the mean normal; false if there is none.
bool make_frame(const FacetCorners &corners, Frame &frame) {
  const Tensor<1, 3> diagonal_0 = corners[3] - corners[0], diagonal_1 = corners[2] - corners[1];
  const Tensor<1, 3> area_vector = dealii::cross_product_3d(diagonal_0, diagonal_1);
  if (!facet::has_area(diagonal_0, diagonal_1, area_vector))
    return false;
  frame = Frame::from_normal(area_vector / area_vector.norm());
  return true;
}

} // namespace

Tensor<2, 3> facet_rotation(const FacetCorners &from, const FacetCorners &to) {
  Tensor<2, 3> rotation = dealii::unit_symmetric_tensor<3>();
  Frame old_frame, frame;
  if (!make_frame(from, old_frame) || !make_frame(to, frame))
    return rotation;
  // With the corners' coordinates p on the old and s on the new q and r, from their means, the angle from p
  // to s that makes Σ |turned p − s|² least has the cosine Σ p·s and the sine Σ p × s, but for a common
  // factor.
  const Tensor<1, 3> old_centre = 0.25 * (from[0] + from[1] + from[2] + from[3]),
                     centre = 0.25 * (to[0] + to[1] + to[2] + to[3]);
  double cosine = 0., sine = 0.;
  for (unsigned int a = 0; a < 4; ++a) {
    const Tensor<1, 3> old_arm = from[a] - old_centre, arm = to[a] - centre;
    const double p_q = old_arm * old_frame.q, p_r = old_arm * old_frame.r, s_q = arm * frame.q,
                 s_r = arm * frame.r;
    cosine += p_q * s_q + p_r * s_r;
    sine += p_q * s_r - p_r * s_q;
  }
  const double size = std::hypot(cosine, sine);
  if (size > 0.) { // not after a stretch that leaves no best angle
    cosine /= size;
    sine /= size;
  } else
    cosine = 1.;
  rotation = dealii::outer_product(cosine * frame.q + sine * frame.r, old_frame.q) +
             dealii::outer_product(cosine * frame.r - sine * frame.q, old_frame.r) +
             dealii::outer_product(frame.n, old_frame.n);
  return rotation;
}

} // namespace billet
