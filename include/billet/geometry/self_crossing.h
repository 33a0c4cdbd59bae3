// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_SELF_CROSSING_H
#define BILLET_GEOMETRY_SELF_CROSSING_H

#include <deal.II/base/tensor.h>

#include <array>
#include <optional>
#include <vector>

namespace billet {

/// Finds where a triangulated surface intersects or overlaps itself. Returns the middle of a
/// triangle of which an edge pierces another triangle, or which overlaps with it in their plane.
/// Returns nothing if there is none. Triangles that share a corner, that only touch (as on both
/// sides of a closed seam) or that have no area do not count. Corners of triangles are indices into
/// `points` [length].
std::optional<dealii::Tensor<1, 3>>
find_self_crossing(const std::vector<dealii::Tensor<1, 3>> &points,
                   const std::vector<std::array<unsigned int, 3>> &triangles);

} // namespace billet

#endif
