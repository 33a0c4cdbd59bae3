// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/thin_tool_watch.h"

#include <algorithm>

namespace billet {

namespace {

struct ThinToolLimits {
  /// Thickness below which a tool is watched [facet sizes]: exceeds the travel of a node in a step,
  /// and its penetration.
  static constexpr double far = 2.;
  /// Thickness over size up to which a tool is one flat surface: boxes of CAD faces reach a
  /// tolerance beyond them.
  static constexpr double flat = 1e-6;
  /// Parts of the thickness. Paths that enter less than `deep` only graze the tool. The path is
  /// looked at in increments of `fine` where the tool is near. Above `middle` the other side is
  /// about as near.
  static constexpr double deep = 0.1, fine = 0.125, middle = 0.45;
  /// Cosine: a node in one side of a square edge may enter through the other.
  static constexpr double square = 1e-6;
  /// Cosine between normals, deep inside, below which an edge is in between: 60 degrees.
  static constexpr double turned = 0.5;
};

} // namespace

std::optional<ThinToolWatch> ThinToolWatch::make(const RigidSurface &surface, const double max_facet_size) {
  const BoundingBox &box = surface.bounding_box();
  double thickness = box.high[0] - box.low[0];
  for (unsigned int i = 1; i < 3; ++i)
    thickness = std::min(thickness, box.high[i] - box.low[i]);
  const double size = (box.high - box.low).norm();
  if (!(thickness > ThinToolLimits::flat * size && thickness < ThinToolLimits::far * max_facet_size))
    return {};
  return ThinToolWatch(surface, thickness);
}

bool ThinToolWatch::passes(const std::size_t i, const Node &node) const {
  const double deep = ThinToolLimits::deep * thickness_, fine = ThinToolLimits::fine * thickness_;
  if (node.penetration > ThinToolLimits::middle * thickness_)
    return true;
  const dealii::Tensor<1, 3> &from = positions_n_[i], &to = node.position;
  const dealii::Tensor<1, 3> way = to - from;
  const double length = way.norm();
  if (!(length > 0.) || node.distance > length)
    return false;
  const auto start = surface_->project(from, node.patch), end = surface_->project(to, node.patch);
  const bool starts_inside = start.exists && start.gap < 0., ends_inside = end.exists && end.gap < 0.;
  if (starts_inside || ends_inside) {
    // The node passes from one side to the other or, deep inside, from the end of the tool to a
    // side: an edge cuts in.
    const double turned = start.exists && end.exists ? start.normal * end.normal : 1.;
    return turned < -ThinToolLimits::square ||
           (turned < ThinToolLimits::turned && std::max(start.gap, end.gap) < -deep);
  }
  // From outside to outside: each increment is a distance in which the node cannot meet the tool.
  for (double done = std::max(start.gap, fine); done < length;) {
    const auto here = surface_->project(from + done / length * way, node.patch);
    if (here.exists && here.gap < -deep)
      return true;
    done += std::max(here.gap, fine);
  }
  return false;
}

} // namespace billet
