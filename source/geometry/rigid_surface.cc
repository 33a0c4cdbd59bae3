// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/rigid_surface.h"

#include "billet/geometry/frame.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace billet {

using dealii::Tensor;

namespace {

constexpr double far_round_off = 1e-7; // round-off of closest points, relative to the distance
constexpr double smooth = 1e-6;        // maximum sine of the angle between normals at a smooth seam
// Maximum sine of the angle by which an arm may lean along an edge.
constexpr double along_edge = 1e-4;

/// Whether a corner's normal lies among those of its patches, or about as near to their mean.
/// Otherwise it points beyond a free edge that ends in the corner.
bool is_between(const Tensor<1, 3> &normal, const std::vector<Tensor<1, 3>> &normals,
                const Tensor<1, 3> &mean) {
  constexpr double slack = 0.1; // radians
  double widest = 0.;
  for (const auto &other : normals)
    widest = std::max(widest, std::acos(std::clamp(other * mean, -1., 1.)));
  return std::acos(std::clamp(normal * mean, -1., 1.)) <= 2. * widest + slack;
}

std::vector<BoundingBox> patch_boxes(const SurfacePatches &patches) {
  std::vector<BoundingBox> boxes;
  boxes.reserve(patches.size());
  for (const auto &patch : patches)
    boxes.push_back(patch->bounding_box());
  return boxes;
}

} // namespace

RigidSurface::RigidSurface(SurfacePatches patches)
    : patches_(std::move(patches)), tree_(patch_boxes(patches_)), box_(BoundingBox::empty()) {
  for (const auto &patch : patches_) {
    const BoundingBox box = patch->bounding_box();
    box_.add(box);
    const double size = (box.high - box.low).norm();
    if (std::isfinite(size))
      tolerance_ = std::max({tolerance_, 1e-7 * size, 2. * patch->edge_accuracy()});
  }
}

RigidSurface::Projection RigidSurface::project(const Tensor<1, 3> &x, const unsigned int first_patch) const {
  unsigned int nearest_patch = first_patch < patches_.size() ? first_patch : 0;
  ClosestPoint nearest = patches_[nearest_patch]->closest_point(x);
  if (patches_.size() > 1) {
    double nearest_square = (x - nearest.position).norm_square();
    // If patches are equally near, the first in the set is chosen, for any guess.
    tree_.visit_near(x, nearest_square, [&](const unsigned int i) {
      if (i == nearest_patch || patches_[i]->is_farther(x, nearest_square))
        return;
      const ClosestPoint point = patches_[i]->closest_point(x);
      const double square = (x - point.position).norm_square();
      const bool is_nearer = square < nearest_square || (square == nearest_square && i < nearest_patch);
      if (is_nearer) {
        nearest = point;
        nearest_square = square;
        nearest_patch = i;
      }
    });
  }
  if (nearest.is_beyond_edge)
    return project_beyond_edge(x, nearest, nearest_patch);
  return {true, nearest.normal, nearest.gap, nearest.turning, nearest_patch};
}

/// Returns the patches that are as near to x, at the same point.
RigidSurface::Neighbours RigidSurface::find_neighbours(const Tensor<1, 3> &x, const ClosestPoint &nearest,
                                                       const unsigned int patch) const {
  Neighbours found;
  found.normals = {nearest.normal};
  found.turning = nearest.turning;
  const double distance = (x - nearest.position).norm();
  const double tolerance = tolerance_ + far_round_off * distance;
  const double reach = distance + tolerance;
  Tensor<1, 3> sum = nearest.normal;
  tree_.visit_near(x, reach * reach, [&](const unsigned int i) {
    if (i == patch || patches_[i]->is_farther(x, reach * reach))
      return;
    const ClosestPoint point = patches_[i]->closest_point(x);
    if ((point.position - nearest.position).norm() > tolerance)
      return;
    if (!point.is_beyond_edge && (!found.is_straight_below || i < found.below.patch)) {
      found.is_straight_below = true;
      found.below = {true, point.normal, point.gap, point.turning, i};
    }
    found.normals.push_back(point.normal);
    sum += point.normal;
    found.turning += point.turning;
    const Tensor<1, 3> across = dealii::cross_product_3d(nearest.normal, point.normal);
    if (across.norm() > found.sharpness) {
      found.sharpness = across.norm();
      found.edge = across / found.sharpness;
      found.sharpest = i;
      found.sharpest_normal = point.normal;
    }
  });
  found.turning /= double(found.normals.size());
  found.mean = sum.norm() > 1e-6 ? sum / sum.norm() : nearest.normal; // arbitrary for a knife edge
  return found;
}

RigidSurface::Projection RigidSurface::project_beyond_edge(const Tensor<1, 3> &x, const ClosestPoint &nearest,
                                                           const unsigned int patch) const {
  const Tensor<1, 3> arm = x - nearest.position;
  const double distance = arm.norm();
  const double along = arm * nearest.normal;
  const double beyond = (arm - along * nearest.normal).norm();
  const Projection none{false, nearest.normal, distance, {}, patch, beyond, along < 0.};
  if (patches_.size() == 1)
    return none;
  const Neighbours around = find_neighbours(x, nearest, patch);
  if (around.normals.size() == 1)
    return none;
  if (around.is_straight_below) // equally near within round-off
    return around.below;

  // The surface continues beyond the seam, which acts as an edge: seen from outside if the tool is
  // convex, from inside if it is concave. The gap is the distance to it, with the sign given by the
  // mean normal.
  Projection projection{true, around.mean, arm * around.mean, around.turning, patch};
  if (around.sharpness < smooth || around.sharpness * distance <= tolerance_) {
    const double aside = (arm - projection.gap * around.mean).norm();
    // There is none past the seam's end.
    return aside > 2. * smooth * distance + tolerance_ ? none : projection;
  }
  projection.gap = projection.gap < 0. ? -distance : distance;
  projection.normal = arm / projection.gap;
  projection.turning = projector_across(projection.normal) / projection.gap;
  if (std::abs(arm * around.edge) <= along_edge * distance + tolerance_)
    projection.turning += turning_along_edge(projection, nearest, patch, around) *
                          dealii::outer_product(around.edge, around.edge);
  else if (around.normals.size() == 2 || !is_between(projection.normal, around.normals, around.mean))
    return none; // past the edge's end; three patches make a corner
  return projection;
}

RigidSurface::EdgePoint RigidSurface::edge_point(const Tensor<1, 3> &x, const unsigned int patch,
                                                 const double width) const {
  const ClosestPoint nearest = patches_[patch]->closest_point(x);
  const Tensor<1, 3> arm = x - nearest.position;
  EdgePoint edge_point{nearest.normal, arm * nearest.normal, {}, 0., {}, {}};
  const Tensor<1, 3> aside = arm - edge_point.gap * nearest.normal;
  edge_point.beyond = aside.norm();
  if (!(edge_point.beyond > 0.))
    return edge_point;
  edge_point.outward = aside / edge_point.beyond;
  // Derivatives of the edge's point and normal by x, from central differences, since patches do not
  // provide them.
  const Tensor<1, 3> along = dealii::cross_product_3d(edge_point.normal, edge_point.outward);
  // Smaller steps leave mostly round-off.
  const double h = std::max(1e-3 * edge_point.beyond, 1e-6 * width);
  const ClosestPoint before = patches_[patch]->closest_point(x - h * along),
                     after = patches_[patch]->closest_point(x + h * along);
  const double carried = along * (after.position - before.position) / (2. * h);
  const double bend = along * (after.normal - before.normal) / (2. * h);
  const Tensor<2, 3> twice = dealii::outer_product(along, along);
  edge_point.spreading = (1. - carried - edge_point.gap * bend) / edge_point.beyond * twice;
  edge_point.turning = bend * twice;
  return edge_point;
}

double RigidSurface::turning_along_edge(const Projection &projection, const ClosestPoint &nearest,
                                        const unsigned int patch, const Neighbours &around) const {
  // Both patches determine the edge's curvature vector k in the plane across the edge: on the
  // surface e·∂n/∂x·e = −k·n. With n = a n_1 + b n_2, the value for n is κ = a κ_1 + b κ_2.
  const auto curvature = [&](const unsigned int i) {
    return around.edge * patches_[i]->closest_point(nearest.position).turning * around.edge;
  };
  const double cosine = nearest.normal * around.sharpest_normal;
  const double first = projection.normal * nearest.normal,
               second = projection.normal * around.sharpest_normal;
  const double kappa = ((first - cosine * second) * curvature(patch) +
                        (second - cosine * first) * curvature(around.sharpest)) /
                       (1. - cosine * cosine);
  const double stretch = 1. + kappa * projection.gap; // 0 in the centre of curvature
  return (std::abs(stretch) > 1e-12 ? kappa / stretch : 0.) - 1. / projection.gap;
}

SurfaceMesh RigidSurface::surface_mesh(const OutputRegion &region) const {
  SurfaceMesh surface_mesh;
  for (const auto &patch : patches_)
    patch->draw(region, surface_mesh);
  return surface_mesh;
}

} // namespace billet
