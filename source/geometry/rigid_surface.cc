// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/rigid_surface.h"

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/numerics/rtree.h>

#include <cmath>
#include <utility>

namespace billet {

using dealii::Tensor;

/// Boxes of bounded patches in an R-tree; unbounded ones aside.
struct RigidSurface::Tree {
  using Entry = std::pair<dealii::BoundingBox<3>, unsigned int>;
  dealii::RTree<Entry> bounded;
  std::vector<unsigned int> unbounded;
};

namespace {

/// Up to so many patches are looked at one after the other.
constexpr std::size_t few_patches = 4;

/// A move of x by δ moves its foot on a curved edge by (e·δ)/(1 − (x − foot)·k) e with the edge's curvature
/// vector k, of which both surfaces know a part, n_i·k = −e·W_i e: W_i is their turning on the edge.
double slide_along_edge(const Tensor<1, 3> &arm, const Tensor<1, 3> &e, const ClosestPoint &first,
                        const ClosestPoint &second) {
  const double cosine = first.normal * second.normal, square_of_sine = 1. - cosine * cosine;
  const double along_first = (arm * first.normal - cosine * (arm * second.normal)) / square_of_sine,
               along_second = (arm * second.normal - cosine * (arm * first.normal)) / square_of_sine;
  return 1. / (1. + along_first * (e * (first.turning * e)) + along_second * (e * (second.turning * e)));
}

} // namespace

RigidSurface::RigidSurface(std::vector<std::unique_ptr<const SurfacePatch>> patches)
    : patches_(std::move(patches)), box_(BoundingBox::empty()) {
  auto tree = std::make_unique<Tree>();
  std::vector<Tree::Entry> entries;
  for (unsigned int i = 0; i < patches_.size(); ++i) {
    boxes_.push_back(patches_[i]->bounding_box());
    const BoundingBox &box = boxes_.back();
    box_.add(box);
    const double size = (box.high - box.low).norm();
    if (!std::isfinite(size)) {
      tree->unbounded.push_back(i);
      continue;
    }
    tolerance_ = std::max(tolerance_, 1e-7 * size);
    entries.push_back({dealii::BoundingBox<3>({dealii::Point<3>(box.low), dealii::Point<3>(box.high)}), i});
  }
  if (patches_.size() > few_patches)
    tree->bounded = dealii::pack_rtree(entries);
  tree_ = std::move(tree);
}

RigidSurface::~RigidSurface() = default;

template <class Visit>
void RigidSurface::visit_near(const Tensor<1, 3> &x, const double &largest_square, const Visit &visit) const {
  if (patches_.size() <= few_patches) {
    for (unsigned int i = 0; i < patches_.size(); ++i)
      if (boxes_[i].distance_square(x) <= largest_square)
        visit(i);
    return;
  }
  for (const unsigned int i : tree_->unbounded)
    visit(i);
  namespace index = boost::geometry::index;
  const auto size = static_cast<unsigned int>(tree_->bounded.size());
  for (auto entry = tree_->bounded.qbegin(index::nearest(dealii::Point<3>(x), size));
       entry != tree_->bounded.qend(); ++entry) {
    if (boxes_[entry->second].distance_square(x) > largest_square)
      break;
    visit(entry->second);
  }
}

RigidSurface::Projection RigidSurface::project(const Tensor<1, 3> &x, const unsigned int first_patch) const {
  unsigned int nearest_patch = first_patch < patches_.size() ? first_patch : 0;
  ClosestPoint nearest = patches_[nearest_patch]->closest_point(x);
  if (patches_.size() > 1) {
    double nearest_square = (x - nearest.position).norm_square();
    // Of patches that are equally near, the first in the set counts, whatever the guess.
    visit_near(x, nearest_square, [&](const unsigned int i) {
      if (i == nearest_patch)
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
  if (nearest.is_beyond_border)
    return project_beyond_border(x, nearest, nearest_patch);
  return {true, nearest.normal, nearest.gap, nearest.turning, nearest_patch};
}

RigidSurface::Projection RigidSurface::project_beyond_border(const Tensor<1, 3> &x,
                                                             const ClosestPoint &nearest,
                                                             const unsigned int patch) const {
  const Tensor<1, 3> arm = x - nearest.position;
  const double distance = arm.norm();
  const double reach = distance + tolerance_;
  Tensor<1, 3> normals = nearest.normal, edge;
  Tensor<2, 3> turning = nearest.turning;
  unsigned int sharpest = patch; // the neighbour across the sharpest edge
  unsigned int n_neighbours = 0;
  double sharpness = 0.;
  if (patches_.size() > 1)
    visit_near(x, reach * reach, [&](const unsigned int i) {
      if (i == patch)
        return;
      const ClosestPoint point = patches_[i]->closest_point(x);
      if ((point.position - nearest.position).norm() > tolerance_)
        return;
      ++n_neighbours;
      normals += point.normal;
      turning += point.turning;
      const Tensor<1, 3> across = dealii::cross_product_3d(nearest.normal, point.normal);
      if (across.norm() > sharpness) {
        sharpness = across.norm();
        edge = across / sharpness;
        sharpest = i;
      }
    });
  if (n_neighbours == 0)
    return {false, nearest.normal, distance, {}, patch};

  // The surface goes on beyond the seam. Seen from there it is an edge: outside of the tool where that is
  // convex, inside where it is concave; the gap is the distance to it, of the sign that the mean normal
  // tells.
  normals = normals.norm() > 1e-6 ? normals / normals.norm() : nearest.normal; // of a knife's edge: any
  Projection projection{true, normals, arm * normals, turning / (1. + n_neighbours), patch};
  constexpr double smooth =
      1e-3; // sine of an angle that counts as none: patches that meet within their accuracy
  if (sharpness < smooth || distance <= tolerance_) {
    const double aside = (arm - projection.gap * normals).norm();
    if (aside > 2. * smooth * distance + tolerance_) // past the seam's end
      return {false, nearest.normal, distance, {}, patch};
    return projection;
  }
  projection.gap = projection.gap < 0. ? -distance : distance;
  projection.normal = arm / projection.gap;
  const Tensor<2, 3> identity = dealii::unit_symmetric_tensor<3>();
  projection.turning = identity - dealii::outer_product(projection.normal, projection.normal);
  if (std::abs(arm * edge) <= 1e-6 * distance)
    projection.turning -= slide_along_edge(arm, edge, patches_[patch]->closest_point(nearest.position),
                                           patches_[sharpest]->closest_point(nearest.position)) *
                          dealii::outer_product(edge, edge);
  else if (n_neighbours == 1) // past the edge's end; three patches make a corner
    return {false, nearest.normal, distance, {}, patch};
  projection.turning /= projection.gap;
  return projection;
}

SurfacePicture RigidSurface::picture(const PictureRegion &region) const {
  SurfacePicture picture;
  for (const auto &patch : patches_)
    patch->draw(region, picture);
  return picture;
}

} // namespace billet
