// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/curved_triangles.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

constexpr double mesh_angle = M_PI / 18.;

/// Returns the bend of an edge with chord d. The tangents' slopes towards `up` at its start and end
/// are m_0 and m_1 [times a length].
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

/// Computes the slope, across `along`, of the tangent at an end of a sharp edge that is orthogonal
/// to the normals of both sides. Returns false if it is steeper than 45°.
bool crease_slope(const Tensor<1, 3> &along, const Tensor<1, 3> &n_a, const Tensor<1, 3> &n_b,
                  Tensor<1, 3> &slope) {
  Tensor<1, 3> tangent = dealii::cross_product_3d(n_a, n_b);
  if (tangent.norm() < 0.2) { // the sharp edge begins or ends here: one tangent plane
    const Tensor<1, 3> n = (n_a + n_b) / (n_a + n_b).norm();
    tangent = along - (along * n) * n;
  }
  slope = tangent / (tangent * along) - along;
  return slope.norm() <= 1.;
}

/// Returns the bend of a sharp edge. `normals` are those of side a at the start and the end, then
/// those of side b.
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

/// Patch of one triangle of a set.
class TrianglePatch final : public SurfacePatch {
public:
  TrianglePatch(std::shared_ptr<const CurvedTriangles> triangles, const unsigned int facet)
      : triangles_(std::move(triangles)), facet_(facet) {}

  ClosestPoint closest_point(const Tensor<1, 3> &x) const override {
    return triangles_->triangle(facet_).closest_point(x, triangles_->shape(facet_));
  }
  bool is_farther(const Tensor<1, 3> &x, const double square) const override {
    return triangles_->triangle(facet_).is_farther(x, square);
  }
  BoundingBox bounding_box() const override { return triangles_->triangle(facet_).bounding_box(); }
  double edge_accuracy() const override { return triangles_->edge_accuracy(); }

  void draw(const OutputRegion & /*region*/, SurfaceMesh &surface_mesh) const override {
    const CurvedTriangle triangle = triangles_->triangle(facet_);
    const auto unit = [&triangle](const double u, const double v) {
      const Tensor<1, 3> normal = triangle.area_normal(u, v);
      return normal / normal.norm();
    };
    const double turned =
        std::max({angle_between(unit(0., 0.), unit(1., 0.)), angle_between(unit(1., 0.), unit(0., 1.)),
                  angle_between(unit(0., 1.), unit(0., 0.))});
    const auto n = static_cast<unsigned int>(std::max(1., std::ceil(turned / mesh_angle)));
    auto row = static_cast<unsigned int>(surface_mesh.points.size());
    for (unsigned int i = 0; i <= n; ++i)
      for (unsigned int j = 0; j <= n - i; ++j)
        surface_mesh.points.push_back(triangle.position(double(j) / n, double(i) / n));
    for (unsigned int i = 0; i < n; row += n - i + 1, ++i)
      for (unsigned int j = 0; j < n - i; ++j) {
        const unsigned int corner = row + j, above = corner + n - i + 1;
        surface_mesh.facets.push_back({corner, corner + 1, above});
        if (j + 1 < n - i)
          surface_mesh.facets.push_back({corner + 1, above + 1, above});
      }
  }

private:
  std::shared_ptr<const CurvedTriangles> triangles_;
  unsigned int facet_;
};

} // namespace

CurvedTriangles::CurvedTriangles(const TriangleMesh &mesh, const TriangleEdges &edges,
                                 const double sharp_angle, const bool is_smoothed)
    : mesh_(mesh), edges_of_facet_(edges.of_facet), facets_(mesh, edges), bends_(edges.edges.size()),
      seams_(mesh.facets.size()) {
  if (is_smoothed) {
    const CornerNormals normals = corner_normals(mesh, edges, facets_, sharp_angle);
    bend_edges(edges, normals, sharp_angle);
    straighten_where_folded();
    join_normals(edges, normals, sharp_angle);
  }
  shapes_.reserve(mesh_.facets.size());
  for (unsigned int f = 0; f < mesh_.facets.size(); ++f)
    shapes_.push_back(facets_.areas[f] > 0. ? triangle(f).shape() : CurvedTriangle::Shape());
}

void CurvedTriangles::bend_edges(const TriangleEdges &edges, const CornerNormals &normals,
                                 const double sharp_angle) {
  for (std::size_t e = 0; e < edges.edges.size(); ++e) {
    const auto &edge = edges.edges[e];
    const auto [a, b] = edge.facets;
    const auto [i, j] = edge.corners;
    const bool is_open_edge = b == TriangleEdges::none;
    // Slivers stay straight.
    if (facets_.areas[a] == 0. || (!is_open_edge && facets_.areas[b] == 0.))
      continue;
    const Tensor<1, 3> d = mesh_.points[edge.points[1]] - mesh_.points[edge.points[0]];
    const Tensor<1, 3> &start = normals[a][i], &end = normals[a][(i + 1) % 3];
    bends_[e] = is_open_edge || !facets_.is_sharp(edge, sharp_angle)
                    ? bend_smooth(d, start, end)
                    : bend_crease(d, {start, end, normals[b][(j + 1) % 3], normals[b][j]});
  }
}

/// Straightens the edges of facets whose triangles would fold over, since the normals are too far
/// from that of the facet. Then straightens those of neighbours that fold as a consequence.
void CurvedTriangles::straighten_where_folded() {
  for (bool continues = true; continues;) {
    continues = false;
    for (unsigned int f = 0; f < mesh_.facets.size(); ++f) {
      bool is_bent = false;
      for (const unsigned int e : edges_of_facet_[f])
        is_bent = is_bent || bends_[e].norm_square() > 0.;
      if (!is_bent || !is_folded(f))
        continue;
      for (const unsigned int e : edges_of_facet_[f])
        bends_[e] = Tensor<1, 3>();
      continues = true;
    }
  }
}

/// Whether the normal deviates too far from that of the flat facet.
bool CurvedTriangles::is_folded(const unsigned int facet) const {
  constexpr std::array<std::array<double, 2>, 9> samples{
      {{0., 0.}, {1., 0.}, {0., 1.}, {0.5, 0.5}, {0., 0.5}, {0.5, 0.}, {0.2, 0.2}, {0.6, 0.2}, {0.2, 0.6}}};
  if (facets_.areas[facet] == 0.)
    return false;
  const CurvedTriangle patch = triangle(facet);
  return std::any_of(samples.begin(), samples.end(), [&](const auto &uv) {
    const double along = patch.area_normal(uv[0], uv[1]) * facets_.normals[facet];
    return !(along > 0.2 * facets_.areas[facet]); // also true for NaN
  });
}

/// Makes the normals of the triangles on both sides of a smooth edge equal along it.
void CurvedTriangles::join_normals(const TriangleEdges &edges, const CornerNormals &normals,
                                   const double sharp_angle) {
  auto seams = seams_;
  for (const auto &edge : edges.edges) {
    if (facets_.is_sharp(edge, sharp_angle) || facets_.areas[edge.facets[0]] == 0. ||
        facets_.areas[edge.facets[1]] == 0.)
      continue;
    for (unsigned int side = 0; side < 2; ++side)
      seams[edge.facets[side]][edge.corners[side]] = seam_at(edge.facets[side], edge.corners[side], normals);
  }
  seams_ = seams;
  for (unsigned int f = 0; f < mesh_.facets.size(); ++f)
    if (is_folded(f))
      seams_[f] = {};
}

CurvedTriangle::Seam CurvedTriangles::seam_at(const unsigned int facet, const unsigned int corner,
                                              const CornerNormals &normals) const {
  const CurvedTriangle patch = triangle(facet); // without seams yet
  const unsigned int next = (corner + 1) % 3, opposite = (corner + 2) % 3;
  const Tensor<1, 3> &n_0 = normals[facet][corner], &n_1 = normals[facet][next];
  const Tensor<1, 3> up = 2. * facets_.areas[facet] * facets_.normals[facet];
  // Rise along `up` with which a step towards the opposite corner is orthogonal to the normal.
  const auto missing = [&](const double t) {
    std::array<double, 3> at{}, step{-0.5, -0.5, -0.5};
    at[corner] = 1. - t;
    at[next] = t;
    step[opposite] = 1.;
    const SurfacePoint point = patch.point_at(at[1], at[2]);
    const auto derivative = [&](const std::array<double, 3> &direction) {
      return direction[1] * point.p_u + direction[2] * point.p_v;
    };
    std::array<double, 3> along{};
    along[corner] = -1.;
    along[next] = 1.;
    const Tensor<1, 3> tangent = derivative(along), mean = (1. - t) * n_0 + t * n_1;
    const Tensor<1, 3> normal = mean - (mean * tangent) / tangent.norm_square() * tangent;
    return -(derivative(step) * normal) / (up * normal);
  };
  // At the corners it is 0, unless the edge is straighter than the normals require.
  const double first = missing(0.), last = missing(1.);
  const auto line = [&](const double t) {
    return (missing(t) - (1. - t) * first - t * last) / (t * (1. - t));
  };
  const double a = line(0.25), b = line(0.75);
  return {static_cast<float>(0.5 * (a + b)), static_cast<float>(b - a)};
}

SurfacePatches CurvedTriangles::patches(const std::shared_ptr<const CurvedTriangles> &triangles) {
  SurfacePatches result;
  for (unsigned int f = 0; f < triangles->mesh_.facets.size(); ++f)
    if (triangles->facets_.areas[f] > 0.)
      result.push_back(std::make_unique<TrianglePatch>(triangles, f));
  return result;
}

} // namespace billet
