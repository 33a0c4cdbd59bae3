// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/facet_rotation.h"

#include "billet/geometry/derivative.h"
#include "billet/geometry/frame.h"

#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

/// Returns an arbitrary frame about the mean normal.
template <class Number> FrameOf<Number> make_frame(const facet::ExpansionOf<Number> &surface) {
  const Tensor<1, 3, Number> area_vector = surface.mean_area_vector();
  return FrameOf<Number>::from_normal(area_vector / area_vector.norm());
}

} // namespace

template <class Number>
Tensor<2, 3, Number> facet_rotation(const FacetCorners &from, const FacetCornersOf<Number> &to) {
  const facet::Expansion old_surface(from);
  const facet::ExpansionOf<Number> surface(to);
  if (!old_surface.has_area() || !surface.has_area()) {
    Tensor<2, 3, Number> identity;
    for (unsigned int i = 0; i < 3; ++i)
      identity[i][i] = 1.;
    return identity;
  }
  const Frame old_frame = make_frame(old_surface);
  const FrameOf<Number> frame = make_frame(surface);
  // Let p and s be the corners' coordinates, relative to their means, on the old and on the new q
  // and r. The angle that minimises Σ |rotated p − s|² has the cosine Σ p·s and the sine Σ p × s,
  // up to a common factor. Both p and s are ± e_1 ± e_2 ± e_3 with mutually orthogonal signs, so
  // the sums run over these vectors.
  Number cosine = 0., sine = 0.;
  const auto add = [&](const Tensor<1, 3> &p, const Tensor<1, 3, Number> &s) {
    const double p_q = p * old_frame.q, p_r = p * old_frame.r;
    const Number s_q = s * frame.q, s_r = s * frame.r;
    cosine += p_q * s_q + p_r * s_r;
    sine += p_q * s_r - p_r * s_q;
  };
  add(old_surface.e_1, surface.e_1);
  add(old_surface.e_2, surface.e_2);
  add(old_surface.e_3, surface.e_3);
  using std::sqrt;
  const Number square = cosine * cosine + sine * sine;
  if (square > 0.) { // zero after a stretch without a best angle
    const Number size = sqrt(square);
    cosine /= size;
    sine /= size;
  } else {
    cosine = 1.;
    sine = 0.;
  }
  const Tensor<1, 3, Number> q = cosine * frame.q + sine * frame.r, r = cosine * frame.r - sine * frame.q;
  Tensor<2, 3, Number> rotation;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      rotation[i][j] = q[i] * old_frame.q[j] + r[i] * old_frame.r[j] + frame.n[i] * old_frame.n[j];
  return rotation;
}

template Tensor<2, 3> facet_rotation(const FacetCorners &, const FacetCorners &);
template Tensor<2, 3, Derivative> facet_rotation(const FacetCorners &, const FacetCornersOf<Derivative> &);

} // namespace billet
