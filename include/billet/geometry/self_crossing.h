// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_SELF_CROSSING_H
#define BILLET_GEOMETRY_SELF_CROSSING_H

#include <deal.II/base/tensor.h>

#include <array>
#include <optional>
#include <vector>

namespace billet {

/// Where a triangulated surface goes through itself, or lies on itself: the middle of a triangle of which an
/// edge pierces another one, or which overlaps with it in their plane, where the two share no corner; nothing
/// if there is none. Triangles that only touch, as those on both sides of a closed seam, do not count, nor do
/// those without area. Corners of triangles are indices of `points` [length].
std::optional<dealii::Tensor<1, 3>>
find_self_crossing(const std::vector<dealii::Tensor<1, 3>> &points,
                   const std::vector<std::array<unsigned int, 3>> &triangles);

} // namespace billet

#endif
