// SPDX-License-Identifier: LGPL-2.1-or-later
// Computes how far nodes and tools may move before nodes pass through a tool.
#include "billet/contact/tool_paths.h"

#include "billet/contact/crossing.h"

#include <deal.II/physics/transformations.h>

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

/// Increment of paths near and inside the tool [facet sizes]. (T9) covers thinner tools.
constexpr double fine = 0.125;

/// A rigid tool between two placements.
class MovingTool {
public:
  MovingTool(const Tensor<1, 3> &axis, const Placement &from, const Placement &to)
      : axis_(axis), from_(from), to_(to), turns_(from.rotation_angle != to.rotation_angle) {}

  Placement at(const double part) const {
    Placement placement = to_;
    placement.translation = (1. - part) * from_.translation + part * to_.translation;
    if (turns_) {
      placement.rotation_angle = (1. - part) * from_.rotation_angle + part * to_.rotation_angle;
      placement.rotation =
          dealii::Physics::Transformations::Rotations::rotation_matrix_3d(axis_, placement.rotation_angle);
    }
    return placement;
  }
  /// Bounds the path length of a point on a straight path, relative to the tool.
  double bound_way(const Tensor<1, 3> &x_from, const Tensor<1, 3> &x_to) const {
    const double arm = std::max((x_from - from_.moved_centre()).norm(), (x_to - to_.moved_centre()).norm());
    return (x_to - x_from - (to_.translation - from_.translation)).norm() +
           std::abs(to_.rotation_angle - from_.rotation_angle) * arm;
  }

private:
  Tensor<1, 3> axis_;
  const Placement &from_, &to_;
  bool turns_;
};

SurfaceSide locate(const RigidSurface &surface, const unsigned int patch, const Placement &placement,
                   const Tensor<1, 3> &x, const double shallow) {
  using Side = SurfaceSide::Side;
  const Tensor<1, 3> X = placement.to_tool(x);
  const auto here = surface.project(X, patch);
  SurfaceSide result{Side::beyond, std::abs(here.gap), {}, false};
  if (!here.exists) {
    // Part of `shallow` within which a node is still above the surface.
    constexpr double beside_edge = 1e-3;
    if (here.beyond <= beside_edge * shallow)
      result.side = here.is_behind ? Side::behind : Side::front;
    return result;
  }
  result.side = here.gap < 0. ? Side::behind : Side::front;
  result.normal = placement.rotation * here.normal;
  if (result.side == Side::behind && result.distance > shallow) {
    // Tests whether, at twice the depth, the same point of the surface is still nearest, or nearly
    // so.
    constexpr double nearly = 0.6;
    const auto deeper = surface.project(X - result.distance * here.normal, here.patch);
    result.is_too_deep = deeper.exists && deeper.gap > -2. * nearly * result.distance;
  }
  return result;
}

} // namespace

double find_free_part_of_nodes(const RigidContactParts &parts, const ContactPath &path) {
  if (parts.step.is_removed)
    return 1.;
  const Placement &tool_from = path.tools_from[parts.pair.tool], &tool_to = path.tools_to[parts.pair.tool];
  const MovingTool tool(parts.tool.rotation_axis(), tool_from, tool_to);
  const RigidSurface &surface = parts.step.surface;
  const SlaveSurface &slaves = parts.slaves;
  double part = 1.;
  const auto displaced = [&](const std::size_t i, const Vector &displacements) {
    return slaves.nodes[i].reference + slaves.at(i, [&](const std::size_t node) {
      return slaves.nodes[node].displacement_in(displacements);
    });
  };
  for (std::size_t i = 0; i < slaves.nodes.size(); ++i) {
    const ContactPoint &node = slaves.nodes[i];
    const Tensor<1, 3> x_from = displaced(i, path.from), x_to = displaced(i, path.to);
    const double resolution = fine * node.size, length = tool.bound_way(x_from, x_to);
    if (node.is_behind || !(length > (path.is_thorough ? 0. : resolution)) || !std::isfinite(length) ||
        surface.bounding_box().distance_square(tool_from.to_tool(x_from)) > length * length)
      continue;
    part = std::min(part, find_free_part(
                              [&](const double s) {
                                return locate(surface, node.patch, tool.at(s), (1. - s) * x_from + s * x_to,
                                              0.5 * resolution);
                              },
                              length, resolution));
  }
  return part;
}

} // namespace billet
