// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/segment_pair.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

/// Returns the parameter, in [0, 1], of the point of the segment that is nearest to x.
double nearest_parameter(const Segment &segment, const Tensor<1, 3> &x) {
  const Tensor<1, 3> along = segment[1] - segment[0];
  const double square = along.norm_square();
  if (!(square > 0.))
    return 0.;
  return std::min(std::max((x - segment[0]) * along / square, 0.), 1.);
}

Tensor<1, 3> point(const Segment &segment, const double parameter) {
  return (1. - parameter) * segment[0] + parameter * segment[1];
}

SegmentPair pair_at(const Segment &first, const Segment &second, const std::array<double, 2> &parameters) {
  const Tensor<1, 3> difference = point(first, parameters[0]) - point(second, parameters[1]);
  return {parameters, difference, difference.norm(), false};
}

} // namespace

SegmentPair closest_points(const Segment &first, const Segment &second) {
  // Either an end is one of the two points, or both lie inside, on the common perpendicular.
  SegmentPair best = pair_at(first, second, {0., nearest_parameter(second, first[0])});
  const auto consider = [&](const std::array<double, 2> &parameters) {
    const SegmentPair other = pair_at(first, second, parameters);
    if (other.distance < best.distance)
      best = other;
  };
  consider({1., nearest_parameter(second, first[1])});
  consider({nearest_parameter(first, second[0]), 0.});
  consider({nearest_parameter(first, second[1]), 1.});

  const Tensor<1, 3> along_1 = first[1] - first[0], along_2 = second[1] - second[0],
                     between = second[0] - first[0];
  const Tensor<1, 3> across = dealii::cross_product_3d(along_1, along_2);
  const double square = across.norm_square();
  if (!(square > 0.))
    return best;
  const std::array<double, 2> parameters{dealii::cross_product_3d(between, along_2) * across / square,
                                         dealii::cross_product_3d(between, along_1) * across / square};
  if (std::min(parameters[0], parameters[1]) > 0. && std::max(parameters[0], parameters[1]) < 1.) {
    const SegmentPair inner = pair_at(first, second, parameters);
    if (inner.distance <= best.distance) {
      best = inner;
      best.is_crossing = true;
    }
  }
  return best;
}

} // namespace billet
