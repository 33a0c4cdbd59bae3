// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/facet_rotation.h"

#include "billet/geometry/frame.h"

#include <deal.II/base/symmetric_tensor.h>

#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

/// Rows q, r, n: any frame about the mean normal.
Frame make_frame(const facet::Expansion &surface) {
  const Tensor<1, 3> area_vector = surface.mean_area_vector();
  return Frame::from_normal(area_vector / area_vector.norm());
}

} // namespace

Tensor<2, 3> facet_rotation(const FacetCorners &from, const FacetCorners &to) {
  Tensor<2, 3> rotation = dealii::unit_symmetric_tensor<3>();
  const facet::Expansion old_surface(from), surface(to);
  if (!old_surface.has_area() || !surface.has_area())
    return rotation;
  const Frame old_frame = make_frame(old_surface), frame = make_frame(surface);
  // With the corners' coordinates p on the old and s on the new q and r, from their means, the angle from p
  // to s that makes Σ |turned p − s|² least has the cosine Σ p·s and the sine Σ p × s, but for a common
  // factor. They are ± e_1 ± e_2 ± e_3 with signs orthogonal to each other, so that the sums go over these.
  double cosine = 0., sine = 0.;
  const auto add = [&](const Tensor<1, 3> &p, const Tensor<1, 3> &s) {
    const double p_q = p * old_frame.q, p_r = p * old_frame.r, s_q = s * frame.q, s_r = s * frame.r;
    cosine += p_q * s_q + p_r * s_r;
    sine += p_q * s_r - p_r * s_q;
  };
  add(old_surface.e_1, surface.e_1);
  add(old_surface.e_2, surface.e_2);
  add(old_surface.e_3, surface.e_3);
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
