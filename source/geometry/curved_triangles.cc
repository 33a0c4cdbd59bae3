// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/curved_triangles.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace billet {

using dealii::Tensor;

namespace {

constexpr double flat_angle = 2e-4;   // between the normals of a flat region [radians]
constexpr double least_height = 3e-7; // of a facet that has an area, over the size of the mesh
constexpr double picture_angle = M_PI / 18.;

/// Sets that grow together.
class UnionFind {
public:
  explicit UnionFind(const std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0U); }
  unsigned int root(unsigned int i) {
    for (; parent_[i] != i; i = parent_[i])
      parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(const unsigned int a, const unsigned int b) { parent_[root(a)] = root(b); }

private:
  std::vector<unsigned int> parent_;
};

/// Angle between unit vectors, exact where it is small.
double angle(const Tensor<1, 3> &a, const Tensor<1, 3> &b) {
  return 2. * std::atan2((a - b).norm(), (a + b).norm());
}

/// The bend of an edge of chord d with the tangents' slopes m_0 at its start and m_1 at its end towards `up`
/// [both times a length].
Tensor<1, 3> bend(const Tensor<1, 3> &d, const Tensor<1, 3> &up, const double m_0, const double m_1) {
  const double sum = m_0 + m_1;
  if (m_0 * m_1 <= 0. || std::abs(m_0 * m_1 / sum) < 1e-10 * d.norm())
    return {};
  return 2. * m_0 * m_1 / sum * up + std::clamp((m_0 - m_1) / sum, -0.5, 0.5) * d;
}

Tensor<1, 3> bend_smooth(const Tensor<1, 3> &d, const Tensor<1, 3> &n_0, const Tensor<1, 3> &n_1) {
  const Tensor<1, 3> mean = 0.5 * (n_0 + n_1);
  const double square = mean.norm_square();
  return square < 0.25 ? Tensor<1, 3>() : bend(d, mean / square, n_0 * d, -(n_1 * d));
}

/// Slope of the tangent that the normals of both sides allow at an end of a sharp edge, across its direction
/// `along`. False if it is steeper than 45°.
bool crease_slope(const Tensor<1, 3> &along, const Tensor<1, 3> &n_a, const Tensor<1, 3> &n_b,
                  Tensor<1, 3> &slope) {
  Tensor<1, 3> tangent = dealii::cross_product_3d(n_a, n_b);
  if (tangent.norm() < 0.2) { // the edge begins or ends here: one tangent plane
    const Tensor<1, 3> n = (n_a + n_b) / (n_a + n_b).norm();
    tangent = along - (along * n) * n;
  }
  slope = tangent / (tangent * along) - along;
  return slope.norm() <= 1.;
}

/// `normals`: of side a at the start and the end, and of side b.
Tensor<1, 3> bend_crease(const Tensor<1, 3> &d, const std::array<Tensor<1, 3>, 4> &normals) {
  const double length = d.norm();
  const Tensor<1, 3> along = d / length;
  Tensor<1, 3> slope_0, slope_1;
  if (!crease_slope(along, normals[0], normals[2], slope_0) ||
      !crease_slope(along, normals[1], normals[3], slope_1))
    return {};
  const Tensor<1, 3> turn = slope_1 - slope_0;
  if (turn.norm() < 1e-10)
    return {};
  const Tensor<1, 3> up = turn / turn.norm();
  return bend(d, up, -length * (slope_0 * up), length * (slope_1 * up));
}

/// One triangle of a set.
class TrianglePatch final : public SurfacePatch {
public:
  TrianglePatch(std::shared_ptr<const CurvedTriangles> triangles, const unsigned int facet)
      : triangles_(std::move(triangles)), facet_(facet) {}

  ClosestPoint closest_point(const Tensor<1, 3> &x) const override {
    return triangles_->triangle(facet_).closest_point(x, triangles_->convexity(facet_));
  }
  bool is_farther(const Tensor<1, 3> &x, const double square) const override {
    return triangles_->triangle(facet_).is_farther(x, square);
  }
  BoundingBox bounding_box() const override { return triangles_->triangle(facet_).bounding_box(); }
  double border_accuracy() const override { return triangles_->border_accuracy(); }

  void draw(const PictureRegion & /*region*/, SurfacePicture &picture) const override {
    const QuadraticTriangle triangle = triangles_->triangle(facet_);
    const auto unit = [&triangle](const double u, const double v) {
      const Tensor<1, 3> normal = triangle.area_normal(u, v);
      return normal / normal.norm();
    };
    const double turned = std::max({angle(unit(0., 0.), unit(1., 0.)), angle(unit(1., 0.), unit(0., 1.)),
                                    angle(unit(0., 1.), unit(0., 0.))});
    const auto n = static_cast<unsigned int>(std::max(1., std::ceil(turned / picture_angle)));
    auto row = static_cast<unsigned int>(picture.points.size());
    for (unsigned int i = 0; i <= n; ++i)
      for (unsigned int j = 0; j <= n - i; ++j)
        picture.points.push_back(triangle.position(double(j) / n, double(i) / n));
    for (unsigned int i = 0; i < n; row += n - i + 1, ++i)
      for (unsigned int j = 0; j < n - i; ++j) {
        const unsigned int corner = row + j, above = corner + n - i + 1;
        picture.facets.push_back({corner, corner + 1, above});
        if (j + 1 < n - i)
          picture.facets.push_back({corner + 1, above + 1, above});
      }
  }

private:
  std::shared_ptr<const CurvedTriangles> triangles_;
  unsigned int facet_;
};

} // namespace

CurvedTriangles::CurvedTriangles(const TriangleMesh &mesh, const TriangleEdges &edges,
                                 const double sharp_angle, const bool is_smoothed)
    : mesh_(mesh), edges_of_facet_(edges.of_facet), bends_(edges.edges.size()) {
  find_facet_normals(edges);
  if (is_smoothed) {
    bend_edges(edges, corner_normals(edges, sharp_angle), sharp_angle);
    straighten_where_folded();
  }
  convexity_.reserve(mesh_.facets.size());
  for (unsigned int f = 0; f < mesh_.facets.size(); ++f)
    convexity_.push_back(areas_[f] > 0. ? static_cast<float>(triangle(f).convexity()) : 0.F);
  facet_normals_ = {};
}

void CurvedTriangles::find_facet_normals(const TriangleEdges &edges) {
  const double tiny = least_height * mesh_.size();
  std::vector<unsigned int> slivers;
  for (unsigned int f = 0; f < mesh_.facets.size(); ++f) {
    std::array<Tensor<1, 3>, 3> sides;
    double longest = 0.;
    for (unsigned int i = 0; i < 3; ++i) {
      sides[i] = mesh_.points[mesh_.facets[f][(i + 1) % 3]] - mesh_.points[mesh_.facets[f][i]];
      longest = std::max(longest, sides[i].norm());
    }
    const Tensor<1, 3> cross = dealii::cross_product_3d(sides[0], sides[1]);
    const bool is_sliver = cross.norm() <= tiny * longest;
    if (is_sliver) {
      slivers.push_back(f);
      border_accuracy_ = tiny;
    }
    areas_.push_back(is_sliver ? 0. : 0.5 * cross.norm());
    facet_normals_.push_back(is_sliver ? Tensor<1, 3>() : cross / cross.norm());
  }
  // A sliver only connects others: it looks where its neighbour at its longest side does. Chains of slivers
  // take as many rounds as they are long.
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (const unsigned int f : slivers) {
      if (facet_normals_[f].norm_square() > 0.)
        continue;
      double longest = 0.;
      unsigned int neighbour = TriangleEdges::none;
      for (const unsigned int e : edges.of_facet[f]) {
        const auto &edge = edges.edges[e];
        const double length = (mesh_.points[edge.points[1]] - mesh_.points[edge.points[0]]).norm();
        const unsigned int other = edge.facets[edge.facets[0] == f ? 1 : 0];
        if (other != TriangleEdges::none && facet_normals_[other].norm_square() > 0. && length > longest) {
          longest = length;
          neighbour = other;
        }
      }
      if (neighbour == TriangleEdges::none)
        continue;
      facet_normals_[f] = facet_normals_[neighbour];
      goes_on = true;
    }
  }
}

bool CurvedTriangles::is_sharp(const TriangleEdges::Edge &edge, const double sharp_angle) const {
  return edge.facets[1] == TriangleEdges::none ||
         angle(facet_normals_[edge.facets[0]], facet_normals_[edge.facets[1]]) > sharp_angle;
}

/// For each facet the area of the facets that are connected to it in one plane. Large facets collect theirs
/// first.
std::vector<double> CurvedTriangles::flat_region_areas(const TriangleEdges &edges) const {
  std::vector<unsigned int> seeds(mesh_.facets.size());
  std::iota(seeds.begin(), seeds.end(), 0U);
  std::stable_sort(seeds.begin(), seeds.end(),
                   [this](const unsigned int a, const unsigned int b) { return areas_[a] > areas_[b]; });
  std::vector<double> result(mesh_.facets.size());
  std::vector<bool> is_taken(mesh_.facets.size());
  std::vector<unsigned int> region;
  for (const unsigned int seed : seeds) {
    if (is_taken[seed])
      continue;
    is_taken[seed] = true;
    region = {seed};
    double area = 0.;
    for (std::size_t i = 0; i < region.size(); ++i) {
      area += areas_[region[i]];
      for (const unsigned int e : edges.of_facet[region[i]])
        for (const unsigned int other : edges.edges[e].facets)
          if (other != TriangleEdges::none && !is_taken[other] &&
              angle(facet_normals_[seed], facet_normals_[other]) < flat_angle) {
            is_taken[other] = true;
            region.push_back(other);
          }
    }
    for (const unsigned int f : region)
      result[f] = area;
  }
  return result;
}

CurvedTriangles::Normals CurvedTriangles::corner_normals(const TriangleEdges &edges,
                                                         const double sharp_angle) const {
  const auto n_facets = static_cast<unsigned int>(mesh_.facets.size());
  UnionFind groups(3 * static_cast<std::size_t>(n_facets));
  for (const auto &edge : edges.edges) {
    if (is_sharp(edge, sharp_angle))
      continue;
    const auto [a, b] = edge.facets;
    const auto [i, j] = edge.corners; // the second facet walks the edge the other way
    groups.unite(3 * a + i, 3 * b + (j + 1) % 3);
    groups.unite(3 * a + (i + 1) % 3, 3 * b + j);
  }

  const std::vector<double> region_area = flat_region_areas(edges);
  std::vector<double> least_area(3 * static_cast<std::size_t>(n_facets),
                                 std::numeric_limits<double>::infinity());
  for (unsigned int f = 0; f < n_facets; ++f)
    for (unsigned int i = 0; i < 3 && areas_[f] > 0.; ++i) {
      double &least = least_area[groups.root(3 * f + i)];
      least = std::min(least, region_area[f]);
    }

  std::vector<Tensor<1, 3>> sums(3 * static_cast<std::size_t>(n_facets));
  for (unsigned int f = 0; f < n_facets; ++f)
    for (unsigned int i = 0; i < 3 && areas_[f] > 0.; ++i) {
      const auto &point = mesh_.points[mesh_.facets[f][i]];
      const double sides = (mesh_.points[mesh_.facets[f][(i + 1) % 3]] - point).norm_square() *
                           (mesh_.points[mesh_.facets[f][(i + 2) % 3]] - point).norm_square();
      const unsigned int group = groups.root(3 * f + i);
      const bool is_of_region = region_area[f] > (1. + 1e-9) * areas_[f];
      const double ratio = is_of_region ? region_area[f] / (1.4 * least_area[group]) : 1.;
      sums[group] += areas_[f] / sides * std::max(1., std::pow(ratio, 4)) * facet_normals_[f];
    }

  Normals normals(n_facets);
  for (unsigned int f = 0; f < n_facets; ++f)
    for (unsigned int i = 0; i < 3; ++i) {
      const Tensor<1, 3> &sum = sums[groups.root(3 * f + i)];
      normals[f][i] = sum.norm() > 0. ? sum / sum.norm() : facet_normals_[f];
    }
  return normals;
}

void CurvedTriangles::bend_edges(const TriangleEdges &edges, const Normals &normals,
                                 const double sharp_angle) {
  for (std::size_t e = 0; e < edges.edges.size(); ++e) {
    const auto &edge = edges.edges[e];
    const auto [a, b] = edge.facets;
    const auto [i, j] = edge.corners;
    const bool is_border = b == TriangleEdges::none;
    if (areas_[a] == 0. || (!is_border && areas_[b] == 0.)) // of a sliver: straight, as it is
      continue;
    const Tensor<1, 3> d = mesh_.points[edge.points[1]] - mesh_.points[edge.points[0]];
    const Tensor<1, 3> &start = normals[a][i], &end = normals[a][(i + 1) % 3];
    bends_[e] = is_border || !is_sharp(edge, sharp_angle)
                    ? bend_smooth(d, start, end)
                    : bend_crease(d, {start, end, normals[b][(j + 1) % 3], normals[b][j]});
  }
}

/// Where the normals are so far from those of a facet that its triangle would fold over, its edges stay
/// straight; then those of its neighbours that fold now.
void CurvedTriangles::straighten_where_folded() {
  constexpr std::array<std::array<double, 2>, 6> samples{
      {{0., 0.}, {1., 0.}, {0., 1.}, {0.5, 0.5}, {0., 0.5}, {0.5, 0.}}};
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (unsigned int f = 0; f < mesh_.facets.size(); ++f) {
      if (areas_[f] == 0.)
        continue;
      bool is_bent = false, is_folded = false;
      for (const unsigned int e : edges_of_facet_[f])
        is_bent = is_bent || bends_[e].norm_square() > 0.;
      for (const auto &[u, v] : samples)
        is_folded = is_folded || triangle(f).area_normal(u, v) * facet_normals_[f] < 0.2 * areas_[f];
      if (!is_bent || !is_folded)
        continue;
      for (const unsigned int e : edges_of_facet_[f])
        bends_[e] = Tensor<1, 3>();
      goes_on = true;
    }
  }
}

std::vector<std::unique_ptr<const SurfacePatch>>
CurvedTriangles::patches(const std::shared_ptr<const CurvedTriangles> &triangles) {
  std::vector<std::unique_ptr<const SurfacePatch>> result;
  for (unsigned int f = 0; f < triangles->mesh_.facets.size(); ++f)
    if (triangles->areas_[f] > 0.)
      result.push_back(std::make_unique<TrianglePatch>(triangles, f));
  return result;
}

} // namespace billet
