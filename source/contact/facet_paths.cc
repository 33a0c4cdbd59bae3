// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_paths.h"

#include "billet/contact/crossing.h"
#include "billet/geometry/box_tree.h"
#include "billet/geometry/closest_point.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

using Positions = FacetSearch::Positions;

/// Increment of the path near the surface, relative to the depth.
constexpr double resolution = 0.25;

Tensor<1, 3> between(const Tensor<1, 3> &from, const Tensor<1, 3> &to, const double part) {
  return (1. - part) * from + part * to;
}

/// The facets that one node may touch in a motion, as one surface.
class MovingSurface {
public:
  MovingSurface(const std::vector<SurfaceFacet> &facets, const Positions &from, const Positions &to)
      : facets_(facets), from_(from), to_(to) {}

  std::vector<unsigned int> &candidates() { return candidates_; }

  SurfaceSide locate(const unsigned int node, const double part) const {
    const Tensor<1, 3> x = between(from_[node], to_[node], part);
    SurfaceSide result{SurfaceSide::Side::beyond, std::numeric_limits<double>::infinity(), {}, false};
    Tensor<1, 3> nearest, normals;
    double penetration = 0.;
    constexpr double rounding = 1e-9, straight = 0.5;
    for (const unsigned int f : candidates_) {
      std::array<Tensor<1, 3>, 4> corners;
      for (unsigned int a = 0; a < 4; ++a)
        corners[a] = between(from_[facets_[f].nodes[a]], to_[facets_[f].nodes[a]], part);
      const double size = (corners[3] - corners[0]).norm() + (corners[2] - corners[1]).norm();
      // No point of the facet is farther from its first corner than that.
      if ((x - corners[0]).norm() > result.distance + size)
        continue;
      for (const auto &triangle : {std::array<unsigned int, 3>{0, 1, 3}, {0, 3, 2}}) {
        const Tensor<1, 3> &a = corners[triangle[0]], &b = corners[triangle[1]], &c = corners[triangle[2]];
        const Tensor<1, 3> area = dealii::cross_product_3d(b - a, c - a);
        if (!(area.norm() > 0.))
          continue;
        const Tensor<1, 3> point = closest_point_of_triangle(x, a, b, c);
        const double distance = (x - point).norm();
        if (distance > result.distance + rounding * size)
          continue;
        if (distance < result.distance - rounding * size) // otherwise the two meet there
          normals = 0.;
        normals += area / area.norm();
        if (distance < result.distance) {
          result.distance = distance;
          nearest = point;
          penetration = facets_[f].reach;
        }
      }
    }
    if (!(normals.norm() > 0.))
      return result;
    result.normal = normals / normals.norm();
    const double height = (x - nearest) * result.normal;
    if (std::abs(height) >= straight * result.distance)
      result.side = height < 0. ? SurfaceSide::Side::behind : SurfaceSide::Side::front;
    result.is_too_deep = result.side == SurfaceSide::Side::behind && result.distance > penetration;
    return result;
  }

  /// Bounds the path length of the node relative to any point of the candidates.
  double bound_way(const unsigned int node) const {
    double longest = 0.;
    for (const unsigned int f : candidates_)
      for (const unsigned int corner : facets_[f].nodes)
        longest = std::max(longest, (to_[node] - from_[node] - (to_[corner] - from_[corner])).norm());
    return longest;
  }

  double min_penetration() const {
    double minimum = std::numeric_limits<double>::infinity();
    for (const unsigned int f : candidates_)
      minimum = std::min(minimum, facets_[f].reach);
    return minimum;
  }

  /// Removes the facets that the node is directly behind at the start, and too deep.
  void drop_walls_above(const unsigned int node) {
    const std::vector<unsigned int> all = candidates_;
    std::vector<unsigned int> kept;
    for (const unsigned int f : all) {
      candidates_.assign(1, f);
      if (!locate(node, 0.).is_too_deep)
        kept.push_back(f);
    }
    candidates_ = kept;
  }

private:
  const std::vector<SurfaceFacet> &facets_;
  const Positions &from_, &to_;
  std::vector<unsigned int> candidates_;
};

/// Returns the facets around each node.
std::vector<std::vector<unsigned int>> collect_around(const std::vector<SurfaceFacet> &facets,
                                                      const std::size_t n_nodes) {
  std::vector<std::vector<unsigned int>> around(n_nodes);
  for (unsigned int f = 0; f < facets.size(); ++f)
    for (const unsigned int node : facets[f].nodes)
      around[node].push_back(f);
  return around;
}

} // namespace

FacetPaths::FacetPaths(MPI_Comm communicator, const FacetSearch::Partners partners,
                       std::vector<std::uint64_t> node_keys, std::vector<SurfaceFacet> facets,
                       const std::vector<double> penetrations)
    : communicator_(communicator), partners_(partners), exchange_(communicator, std::move(node_keys), [&] {
        // Here ghosts transfer the depth as their reach.
        for (std::size_t f = 0; f < facets.size(); ++f)
          facets[f].reach = penetrations[f];
        return std::move(facets);
      }()) {
  for (const double penetration : penetrations) {
    min_penetration_ = std::min(min_penetration_, penetration);
    max_penetration_ = std::max(max_penetration_, penetration);
  }
  MPI_Allreduce(MPI_IN_PLACE, &min_penetration_, 1, MPI_DOUBLE, MPI_MIN, communicator_);
  MPI_Allreduce(MPI_IN_PLACE, &max_penetration_, 1, MPI_DOUBLE, MPI_MAX, communicator_);
}

double FacetPaths::find_free_part(const Positions &from, const Positions &to, const bool is_thorough) {
  std::array<double, 6> ends; // maximum of −motion and of motion
  ends.fill(-std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < from.size(); ++i)
    for (unsigned int c = 0; c < 3; ++c) {
      ends[c] = std::max(ends[c], from[i][c] - to[i][c]);
      ends[3 + c] = std::max(ends[3 + c], to[i][c] - from[i][c]);
    }
  MPI_Allreduce(MPI_IN_PLACE, ends.data(), 6, MPI_DOUBLE, MPI_MAX, communicator_);
  Tensor<1, 3> common, range;
  for (unsigned int c = 0; c < 3; ++c) {
    common[c] = 0.5 * (ends[3 + c] - ends[c]);
    range[c] = ends[3 + c] + ends[c];
  }
  const double min_way = is_thorough ? 0. : resolution * min_penetration_;
  if (!(range.norm() > min_way) || !std::isfinite(range.norm()))
    return 1.;
  Positions start = from, end = to; // a common motion takes no node through a facet
  for (auto &x : end)
    x -= common;
  exchange_.rebuild(start, end, max_penetration_);
  exchange_.update(start);
  exchange_.update(end);
  double part = find_free_part_of_rank(start, end, min_way);
  MPI_Allreduce(MPI_IN_PLACE, &part, 1, MPI_DOUBLE, MPI_MIN, communicator_);
  return part;
}

double FacetPaths::find_free_part_of_rank(const Positions &from, const Positions &to,
                                          const double min_way) const {
  const std::vector<SurfaceFacet> &facets = exchange_.facets();
  std::vector<BoundingBox> boxes(facets.size(), BoundingBox::empty());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (const unsigned int node : facets[f].nodes) {
      boxes[f].add(from[node]);
      boxes[f].add(to[node]);
    }
    boxes[f].enlarge(facets[f].reach);
  }
  const BoxTree tree(boxes);
  const bool with_self = partners_ == FacetSearch::Partners::other_surfaces_and_self;
  const auto around = collect_around(facets, exchange_.n_nodes());
  MovingSurface surface(facets, from, to);
  const auto is_excluded = [&](const unsigned int node, const unsigned int of_node, const unsigned int f) {
    if (facets[f].surface != of_node)
      return false;
    if (!with_self)
      return true;
    const auto &nodes = facets[f].nodes;
    return std::any_of(around[node].begin(), around[node].end(), [&](const unsigned int own) {
      return std::any_of(facets[own].nodes.begin(), facets[own].nodes.end(), [&](const unsigned int other) {
        return std::find(nodes.begin(), nodes.end(), other) != nodes.end();
      });
    });
  };
  double part = 1.;
  for (unsigned int node = 0; node < exchange_.n_own_nodes(); ++node) {
    if (around[node].empty())
      continue;
    const unsigned int of_node = facets[around[node][0]].surface;
    BoundingBox way = BoundingBox::empty();
    way.add(from[node]);
    way.add(to[node]);
    // The tree searches spheres only: this one surrounds the path.
    const double square = 0.25 * (to[node] - from[node]).norm_square();
    auto &candidates = surface.candidates();
    candidates.clear();
    tree.visit_near(between(from[node], to[node], 0.5), square, [&](const unsigned int f) {
      if (boxes[f].overlaps(way) && !is_excluded(node, of_node, f))
        candidates.push_back(f);
    });
    if (candidates.empty())
      continue;
    std::sort(candidates.begin(), candidates.end(),
              [&](const unsigned int a, const unsigned int b) { return facets[a].key < facets[b].key; });
    surface.drop_walls_above(node);
    const double length = surface.bound_way(node), step = resolution * surface.min_penetration();
    if (candidates.empty() || !(length > min_way))
      continue;
    const double of_node_free =
        billet::find_free_part([&](const double s) { return surface.locate(node, s); }, length, step);
    part = std::min(part, of_node_free);
  }
  return part;
}

} // namespace billet
