// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_SEGMENT_PAIR_H
#define BILLET_GEOMETRY_SEGMENT_PAIR_H

#include <deal.II/base/tensor.h>

#include <array>

namespace billet {

/// End points of a segment.
using Segment = std::array<dealii::Tensor<1, 3>, 2>;

/// Closest points of two segments.
struct SegmentPair {
  std::array<double, 2> parameters; ///< in [0, 1], from the first end to the second
  dealii::Tensor<1, 3> difference;  ///< from the second segment's point to the first's
  double distance;                  ///< [length]
  /// Whether both points are inside the segments, not at their ends, and the segments are not
  /// parallel: the difference is then orthogonal to both.
  bool is_crossing;
};

/// Returns the closest points, for segments of any direction and any length, including 0. If many
/// pairs are equally near (parallel segments side by side), the result contains an end.
SegmentPair closest_points(const Segment &first, const Segment &second);

} // namespace billet

#endif
