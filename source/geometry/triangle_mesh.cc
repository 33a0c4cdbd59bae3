// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/triangle_mesh.h"

#include "billet/geometry/surface_patch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <unordered_map>

namespace billet {

using dealii::Tensor;

namespace {

BoundingBox box_of(const std::vector<Tensor<1, 3>> &points) {
  BoundingBox box = BoundingBox::empty();
  for (const auto &point : points)
    box.add(point);
  return box;
}

std::string describe(const Tensor<1, 3> &point) {
  std::ostringstream text;
  text << '(' << point[0] << ", " << point[1] << ", " << point[2] << ')';
  return text.str();
}

std::string describe_edge(const TriangleMesh &mesh, const std::array<unsigned int, 2> &points) {
  return "from " + describe(mesh.points[points[0]]) + " to " + describe(mesh.points[points[1]]);
}

/// Returns "1 edge has", "2 edges have" etc.
std::string count_edges(const std::size_t n) {
  return std::to_string(n) + (n == 1 ? " edge has" : " edges have");
}

/// Grid of cubes that finds nearby points.
class PointGrid {
public:
  PointGrid(const Tensor<1, 3> &origin, const double tolerance)
      : origin_(origin), tolerance_(tolerance), width_(8. * tolerance) {}

  /// Returns the index of the first of the `points` that is nearer than the tolerance. If there is
  /// none, it adds the point and returns `index`.
  unsigned int find_or_add(const Tensor<1, 3> &point, const unsigned int index,
                           const std::vector<Tensor<1, 3>> &points) {
    // Visit all cubes within the tolerance, usually one.
    std::array<std::array<std::int64_t, 2>, 3> range{};
    for (unsigned int i = 0; i < 3; ++i)
      range[i] = {cube(point[i] - tolerance_ - origin_[i]), cube(point[i] + tolerance_ - origin_[i])};
    for (auto a = range[0][0]; a <= range[0][1]; ++a)
      for (auto b = range[1][0]; b <= range[1][1]; ++b)
        for (auto c = range[2][0]; c <= range[2][1]; ++c) {
          const auto [begin, end] = cubes_.equal_range(key(a, b, c));
          for (auto entry = begin; entry != end; ++entry)
            if ((points[entry->second] - point).norm() <= tolerance_)
              return entry->second;
        }
    cubes_.emplace(key(cube(point[0] - origin_[0]), cube(point[1] - origin_[1]), cube(point[2] - origin_[2])),
                   index);
    return index;
  }

private:
  std::int64_t cube(const double x) const { return static_cast<std::int64_t>(std::floor(x / width_)); }
  /// Returns the key of a cube; collisions only cost time.
  static std::uint64_t key(const std::int64_t a, const std::int64_t b, const std::int64_t c) {
    return (static_cast<std::uint64_t>(a) * 73856093U) ^ (static_cast<std::uint64_t>(b) * 19349663U) ^
           (static_cast<std::uint64_t>(c) * 83492791U);
  }

  Tensor<1, 3> origin_;
  double tolerance_, width_;
  std::unordered_multimap<std::uint64_t, unsigned int> cubes_;
};

} // namespace

double TriangleMesh::size() const {
  const BoundingBox box = box_of(points);
  return (box.high - box.low).norm();
}

bool TriangleMesh::has_area() const {
  return std::any_of(facets.begin(), facets.end(), [this](const auto &facet) {
    const Tensor<1, 3> a = points[facet[1]] - points[facet[0]], b = points[facet[2]] - points[facet[0]];
    return dealii::cross_product_3d(a, b).norm() > 1e-6 * a.norm() * b.norm();
  });
}

double TriangleMesh::six_volumes() const {
  double sum = 0.;
  // This reduces cancellation.
  const Tensor<1, 3> origin = points.empty() ? Tensor<1, 3>() : points.front();
  for (const auto &facet : facets)
    sum += (points[facet[0]] - origin) * dealii::cross_product_3d(Tensor<1, 3>(points[facet[1]] - origin),
                                                                  Tensor<1, 3>(points[facet[2]] - origin));
  return sum;
}

TriangleMesh weld(const TriangleMesh &mesh, const double tolerance) {
  TriangleMesh result;
  PointGrid grid(box_of(mesh.points).low, tolerance);
  std::vector<unsigned int> new_index;
  new_index.reserve(mesh.points.size());
  for (const auto &point : mesh.points) {
    const auto next = static_cast<unsigned int>(result.points.size());
    new_index.push_back(grid.find_or_add(point, next, result.points));
    if (new_index.back() == next)
      result.points.push_back(point);
  }
  for (const auto &facet : mesh.facets) {
    const std::array<unsigned int, 3> corners{new_index[facet[0]], new_index[facet[1]], new_index[facet[2]]};
    if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
      result.facets.push_back(corners);
  }
  return result;
}

TriangleEdges::TriangleEdges(const TriangleMesh &mesh) : of_facet(mesh.facets.size()) {
  struct HalfEdge {
    std::array<unsigned int, 2> sorted;
    unsigned int facet, corner;
  };
  std::vector<HalfEdge> half_edges;
  half_edges.reserve(3 * mesh.facets.size());
  for (unsigned int f = 0; f < mesh.facets.size(); ++f)
    for (unsigned int i = 0; i < 3; ++i) {
      const unsigned int a = mesh.facets[f][i], b = mesh.facets[f][(i + 1) % 3];
      half_edges.push_back({{std::min(a, b), std::max(a, b)}, f, i});
    }
  std::sort(half_edges.begin(), half_edges.end(), [](const HalfEdge &a, const HalfEdge &b) {
    return std::tie(a.sorted, a.facet) < std::tie(b.sorted, b.facet);
  });

  std::size_t n_crowded = 0, n_against = 0;
  Edge crowded{}, against{};
  for (std::size_t begin = 0, end = 0; begin < half_edges.size(); begin = end) {
    while (end < half_edges.size() && half_edges[end].sorted == half_edges[begin].sorted)
      ++end;
    Edge edge{{}, {none, none}, {}};
    for (std::size_t i = begin; i < std::min(begin + 2, end); ++i) {
      const HalfEdge &half = half_edges[i];
      edge.facets[i - begin] = half.facet;
      edge.corners[i - begin] = half.corner;
      of_facet[half.facet][half.corner] = static_cast<unsigned int>(edges.size());
    }
    const auto start = [&](const unsigned int i) { return mesh.facets[edge.facets[i]][edge.corners[i]]; };
    const auto &sorted = half_edges[begin].sorted;
    edge.points = {start(0), start(0) == sorted[0] ? sorted[1] : sorted[0]};
    if (end - begin > 2 && n_crowded++ == 0)
      crowded = edge;
    if (end - begin == 2 && start(1) == start(0) && n_against++ == 0)
      against = edge;
    edges.push_back(edge);
  }
  if (n_crowded > 0)
    throw std::invalid_argument(count_edges(n_crowded) + " more than two facets, such as that " +
                                describe_edge(mesh, crowded.points));
  if (n_against > 0)
    throw std::invalid_argument(
        count_edges(n_against) +
        " facets of opposite orientation: both have it in the same direction, such as that " +
        describe_edge(mesh, against.points));
}

std::string TriangleEdges::describe_open_edges(const TriangleMesh &mesh) const {
  std::size_t n = 0;
  const Edge *example = nullptr;
  for (const auto &edge : edges)
    if (edge.facets[1] == none && n++ == 0)
      example = &edge;
  return n == 0 ? ""
                : count_edges(n) + " a facet on one side only, such as that " +
                      describe_edge(mesh, example->points);
}

} // namespace billet
