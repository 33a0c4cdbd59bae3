// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/trimmed_surface.h"

#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

TrimmedSurface::TrimmedSurface(Description description)
    : d_(std::move(description)), loops_(1e-7 * std::min(d_.high[0] - d_.low[0], d_.high[1] - d_.low[1])) {
  for (const Edge &edge : d_.edges) {
    loops_.add(edge.on_surface, edge.samples);
    if (!edge.is_seam)
      border_.push_back(edge);
  }
  d_.edges.clear();
}

ClosestPoint TrimmedSurface::closest_point(const Tensor<1, 3> &x) const {
  if (d_.closed_form) {
    const Parameters parameters = d_.closed_form(x);
    return is_inside(parameters) ? at_foot(regular_point(parameters), x, d_.side) : nearest_on_border(x);
  }
  std::optional<ClosestPoint> border;
  const auto foot = d_.surface.nearest(
      x,
      [this](const SurfaceFoot &f) {
        return border_.empty() || (!f.is_at_bound && is_inside({f.u, f.v}));
      },
      [&] {
        border = nearest_on_border(x);
        return (x - border->position).norm();
      });
  return foot ? at_foot(*foot, x, d_.side) : *border;
}

bool TrimmedSurface::is_inside(Parameters parameters) const {
  if (border_.empty())
    return true;
  for (unsigned int i = 0; i < 2; ++i)
    if (d_.periods[i] > 0.)
      parameters[i] -= d_.periods[i] * std::floor((parameters[i] - d_.low[i]) / d_.periods[i]);
  return loops_.contains(parameters);
}

/// At a pole of the parameters, the derivatives next to it.
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

ClosestPoint TrimmedSurface::nearest_on_border(const Tensor<1, 3> &x) const {
  double least = std::numeric_limits<double>::infinity(), parameter = 0.;
  const Edge *nearest = nullptr;
  Tensor<1, 3> position;
  for (const Edge &edge : border_) {
    const double t = edge.is_pole ? 0.5 * (edge.samples.front() + edge.samples.back()) : edge.nearest(x);
    const Parameters at = edge.on_surface(t);
    // The edge's own curve is the same for both of its faces.
    const Tensor<1, 3> p = edge.is_pole ? d_.surface.at(at[0], at[1]).p : edge.position(t);
    if ((x - p).norm_square() < least) {
      least = (x - p).norm_square();
      parameter = t;
      nearest = &edge;
      position = p;
    }
  }
  SurfacePoint foot = regular_point(nearest->on_surface(parameter));
  foot.p = position;
  ClosestPoint result = at_foot(foot, x, d_.side);
  const Tensor<1, 3> arm = x - position;
  Tensor<1, 3> mean;
  if (nearest->is_pole && least > 0. && is_apex(*nearest, mean)) {
    result.gap = arm * mean < 0. ? -arm.norm() : arm.norm();
    result.normal = arm / result.gap;
    const Tensor<2, 3> identity = dealii::unit_symmetric_tensor<3>();
    result.turning = (identity - dealii::outer_product(result.normal, result.normal)) / result.gap;
    return result;
  }
  const Tensor<1, 3> aside = arm - result.gap * result.normal;
  const double size = (d_.box.high - d_.box.low).norm();
  result.is_beyond_border = aside.norm() > 1e-10 * (size + std::sqrt(least));
  return result;
}

/// Whether the surface is pointed at a pole that it goes around.
bool TrimmedSurface::is_apex(const Edge &pole, Tensor<1, 3> &mean_normal) const {
  const double first = pole.samples.front(), last = pole.samples.back();
  const Parameters begin = pole.on_surface(first), end = pole.on_surface(last);
  bool goes_around = false;
  for (unsigned int i = 0; i < 2; ++i)
    goes_around =
        goes_around || (d_.periods[i] > 0. && std::abs(end[i] - begin[i]) > (1. - 1e-9) * d_.periods[i]);
  constexpr unsigned int n = 12;
  mean_normal = {};
  for (unsigned int i = 0; i < n; ++i) {
    const SurfacePoint point = regular_point(pole.on_surface(first + (i + 0.5) / n * (last - first)));
    const Tensor<1, 3> normal = d_.side * dealii::cross_product_3d(point.p_u, point.p_v);
    mean_normal += normal / normal.norm() / double(n);
  }
  return goes_around && mean_normal.norm() < 1. - 1e-4;
}

void TrimmedSurface::draw(const PictureRegion & /*region*/, SurfacePicture &picture) const {
  const auto first = static_cast<unsigned int>(picture.points.size());
  const TriangleMesh &mesh = d_.surface.mesh();
  picture.points.insert(picture.points.end(), mesh.points.begin(), mesh.points.end());
  for (const auto &[a, b, c] : mesh.facets)
    picture.facets.push_back({first + a, first + b, first + c});
}

} // namespace billet
