// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_SEGMENT_PAIR_H
#define BILLET_GEOMETRY_SEGMENT_PAIR_H

#include <deal.II/base/tensor.h>

#include <array>

namespace billet {

/// Two ends.
using Segment = std::array<dealii::Tensor<1, 3>, 2>;

/// The closest points of two segments.
struct SegmentPair {
  std::array<double, 2> parameters; ///< in [0, 1], from the first end to the second
  dealii::Tensor<1, 3> difference;  ///< from the second segment's point to the first's
  double distance;                  ///< [length]
  /// Both points are within the segments and not at their ends, and the segments are not parallel: the
  /// difference stands on both.
  bool is_crossing;
};

/// The true closest points, for segments of any length, also 0, and any direction. Where many pairs are as
/// near (parallel segments side by side) one that has an end in it.
SegmentPair closest_points(const Segment &first, const Segment &second);

} // namespace billet

#endif
