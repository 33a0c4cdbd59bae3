// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/closest_point.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

namespace {

Tensor<1, 3> closest_point_of_segment(const Tensor<1, 3> &x, const Tensor<1, 3> &a, const Tensor<1, 3> &b) {
  const Tensor<1, 3> along = b - a;
  const double square = along.norm_square();
  const double part = square > 0. ? std::clamp((x - a) * along / square, 0., 1.) : 0.;
  return a + part * along;
}

} // namespace

Tensor<1, 3> closest_point_of_triangle(const Tensor<1, 3> &x, const Tensor<1, 3> &a, const Tensor<1, 3> &b,
                                       const Tensor<1, 3> &c) {
  const Tensor<1, 3> normal = dealii::cross_product_3d(b - a, c - a);
  const double square = normal.norm_square();
  // Barycentric coordinates of the projection, times `square`.
  const double of_a = dealii::cross_product_3d(c - b, x - b) * normal,
               of_b = dealii::cross_product_3d(a - c, x - c) * normal,
               of_c = dealii::cross_product_3d(b - a, x - a) * normal;
  if (square > 0. && std::min({of_a, of_b, of_c}) >= 0.)
    return x - ((x - a) * normal / square) * normal;
  Tensor<1, 3> best = closest_point_of_segment(x, a, b);
  for (const auto &other : {closest_point_of_segment(x, b, c), closest_point_of_segment(x, c, a)})
    if ((x - other).norm_square() < (x - best).norm_square())
      best = other;
  return best;
}

} // namespace billet
