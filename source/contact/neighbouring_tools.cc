// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/neighbouring_tools.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

struct NeighbouringToolsLimits {
  /// Minimum cosine between the direction that a tool must face and its normal: 60 degrees. A flank
  /// of a tool counts, its back does not.
  static constexpr double alike = 0.5;
};

} // namespace

bool NeighbouringTools::is_near(const Tensor<1, 3> &position, const double near,
                                const std::optional<Tensor<1, 3>> &facing) const {
  return std::any_of(others_.begin(), others_.end(), [&](const ToolStep *other) {
    if (other->is_removed)
      return false;
    const auto projection = other->surface.project(other->placement.to_tool(position));
    return projection.exists && std::abs(projection.gap) < near &&
           (!facing ||
            *facing * (other->placement.rotation * projection.normal) > NeighbouringToolsLimits::alike);
  });
}

} // namespace billet
