// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/trimmed_surface.h"

#include "billet/geometry/frame.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {
// Minimum length of the mean of the normals around a smooth pole.
constexpr double smooth_pole = 1. - 1e-4;
} // namespace

TrimmedSurface::TrimmedSurface(Description description)
    : d_(std::move(description)), loops_(1e-7 * std::min(d_.high[0] - d_.low[0], d_.high[1] - d_.low[1])) {
  for (const Edge &edge : d_.edges) {
    loops_.add(edge.on_surface, edge.samples);
    if (!edge.is_seam)
      edges_.push_back(edge);
  }
  d_.edges.clear();
  if (!d_.closed_form)
    for (const Edge &edge : edges_)
      if (edge.is_pole && goes_around(edge))
        add_cap(edge);
}

ClosestPoint TrimmedSurface::closest_point(const Tensor<1, 3> &x) const {
  if (d_.closed_form) {
    const Parameters parameters = d_.closed_form(x);
    return is_inside(parameters) ? at_foot(regular_point(parameters), x, d_.side) : nearest_on_edge(x);
  }
  std::optional<ClosestPoint> edge_point;
  const auto foot = d_.surface.nearest(
      x,
      [this](const SurfaceFoot &f) {
        return edges_.empty() || (!f.is_at_bound && is_inside({f.u, f.v}));
      },
      [&] {
        edge_point = nearest_on_edge(x);
        return (x - edge_point->position).norm();
      });
  const Tensor<1, 3> position = foot ? foot->p : edge_point->position;
  for (const Cap &cap : caps_)
    if ((position - cap.position).norm() < cap.radius)
      return cap.project(x);
  return foot ? at_foot(*foot, x, d_.side) : *edge_point;
}

bool TrimmedSurface::is_inside(Parameters parameters) const {
  if (edges_.empty())
    return true;
  for (unsigned int i = 0; i < 2; ++i)
    if (d_.periods[i] > 0.)
      parameters[i] -= d_.periods[i] * std::floor((parameters[i] - d_.low[i]) / d_.periods[i]);
  return loops_.contains(parameters);
}

/// Returns the surface point; at a pole of the parameters, with the derivatives next to it.
SurfacePoint TrimmedSurface::regular_point(const Parameters &parameters) const {
  const auto [u, v] = parameters;
  const SurfacePoint here = d_.surface.at(u, v);
  const double area = dealii::cross_product_3d(here.p_u, here.p_v).norm();
  if (area > 1e-9 * (here.p_u.norm_square() + here.p_v.norm_square()))
    return here;
  constexpr double aside = 1e-6;
  SurfacePoint beside = d_.surface.at(u + aside * (0.5 * (d_.low[0] + d_.high[0]) - u),
                                      v + aside * (0.5 * (d_.low[1] + d_.high[1]) - v));
  beside.p = here.p;
  return beside;
}

ClosestPoint TrimmedSurface::nearest_on_edge(const Tensor<1, 3> &x) const {
  double minimum = std::numeric_limits<double>::infinity(), parameter = 0.;
  const Edge *nearest = nullptr;
  Tensor<1, 3> position;
  for (const Edge &edge : edges_) {
    const double t = edge.is_pole ? 0.5 * (edge.samples.front() + edge.samples.back()) : edge.nearest(x);
    const Parameters at = edge.on_surface(t);
    // The edge's spatial curve is the same for both of its faces.
    const Tensor<1, 3> p = edge.is_pole ? d_.surface.at(at[0], at[1]).p : edge.position(t);
    if ((x - p).norm_square() < minimum) {
      minimum = (x - p).norm_square();
      parameter = t;
      nearest = &edge;
      position = p;
    }
  }
  SurfacePoint foot = regular_point(nearest->on_surface(parameter));
  foot.p = position;
  ClosestPoint result = at_foot(foot, x, d_.side);
  const Tensor<1, 3> arm = x - position;
  if (nearest->is_pole && goes_around(*nearest)) { // a point inside the surface, not on an edge
    const Tensor<1, 3> mean = mean_normal(*nearest);
    if (mean.norm() < smooth_pole && minimum > 0.) { // it is a tip
      result.gap = arm * mean < 0. ? -arm.norm() : arm.norm();
      result.normal = arm / result.gap;
      result.turning = projector_across(result.normal) / result.gap;
    }
    return result;
  }
  const Tensor<1, 3> aside = arm - result.gap * result.normal;
  const double size = (d_.box.high - d_.box.low).norm();
  result.is_beyond_edge = aside.norm() > 1e-10 * (size + std::sqrt(minimum));
  return result;
}

/// Whether the face surrounds a pole.
bool TrimmedSurface::goes_around(const Edge &pole) const {
  const Parameters begin = pole.on_surface(pole.samples.front()), end = pole.on_surface(pole.samples.back());
  for (unsigned int i = 0; i < 2; ++i)
    if (d_.periods[i] > 0. && std::abs(end[i] - begin[i]) > (1. - 1e-9) * d_.periods[i])
      return true;
  return false;
}

/// Returns points around a pole, at the small fraction `aside` of the distance to the middle of the
/// face.
std::vector<SurfacePoint> TrimmedSurface::ring_about(const Edge &pole, const double aside) const {
  constexpr unsigned int n = 12;
  std::vector<SurfacePoint> result;
  const double first = pole.samples.front(), last = pole.samples.back();
  const Parameters begin = pole.on_surface(first), end = pole.on_surface(last);
  const unsigned int along = std::abs(end[0] - begin[0]) > std::abs(end[1] - begin[1]) ? 1 : 0;
  for (unsigned int i = 0; i < n; ++i) {
    Parameters at = pole.on_surface(first + (i + 0.5) / n * (last - first));
    at[along] += aside * (0.5 * (d_.low[along] + d_.high[along]) - at[along]);
    result.push_back(d_.surface.at(at[0], at[1]));
  }
  return result;
}

/// Returns the mean of the normals around a pole; shorter than 1 at a tip.
Tensor<1, 3> TrimmedSurface::mean_normal(const Edge &pole) const {
  Tensor<1, 3> result;
  const auto ring = ring_about(pole, 1e-6);
  for (const auto &point : ring) {
    const Tensor<1, 3> normal = d_.side * dealii::cross_product_3d(point.p_u, point.p_v);
    result += normal / normal.norm() / double(ring.size());
  }
  return result;
}

/// Adds a cap: close to a pole, derivatives are lost in round-off, and the osculating paraboloid
/// replaces the surface.
void TrimmedSurface::add_cap(const Edge &pole) {
  const Tensor<1, 3> mean = mean_normal(pole);
  if (mean.norm() < smooth_pole)
    return;
  Cap cap;
  const Parameters middle = pole.on_surface(0.5 * (pole.samples.front() + pole.samples.back()));
  cap.position = d_.surface.at(middle[0], middle[1]).p;
  cap.normal = mean / mean.norm();
  const auto ring = ring_about(pole, 2e-3);
  cap.radius = std::numeric_limits<double>::infinity();
  for (const auto &point : ring) {
    cap.curvature += at_foot(point, point.p, d_.side).turning / double(ring.size());
    cap.radius = std::min(cap.radius, 0.5 * (point.p - cap.position).norm());
  }
  const Tensor<2, 3> across = projector_across(cap.normal);
  cap.curvature = across * cap.curvature * across;
  caps_.push_back(cap);
}

ClosestPoint TrimmedSurface::Cap::project(const Tensor<1, 3> &x) const {
  const Tensor<1, 3> arm = x - position;
  const double height = arm * normal;
  const Tensor<2, 3> stretch = Tensor<2, 3>(dealii::unit_symmetric_tensor<3>()) + height * curvature;
  // All directions are equally near.
  const bool is_focus = std::abs(dealii::determinant(stretch)) < 1e-12;
  const Tensor<2, 3> shrink = is_focus ? Tensor<2, 3>() : dealii::invert(stretch);
  const Tensor<1, 3> aside = shrink * (arm - height * normal);
  ClosestPoint result;
  result.position = position + aside - 0.5 * (aside * curvature * aside) * normal;
  result.normal = normal + curvature * aside;
  result.normal /= result.normal.norm();
  result.gap = (x - result.position) * result.normal;
  const Tensor<2, 3> across = projector_across(result.normal);
  result.turning = across * shrink * curvature * across;
  return result;
}

void TrimmedSurface::draw(const OutputRegion & /*region*/, SurfaceMesh &surface_mesh) const {
  const auto first = static_cast<unsigned int>(surface_mesh.points.size());
  const TriangleMesh &mesh = d_.surface.mesh();
  surface_mesh.points.insert(surface_mesh.points.end(), mesh.points.begin(), mesh.points.end());
  for (const auto &[a, b, c] : mesh.facets)
    surface_mesh.facets.push_back({first + a, first + b, first + c});
}

} // namespace billet
