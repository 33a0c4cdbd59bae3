// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/parametric_surface.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

ClosestPoint at_foot(const SurfacePoint &foot, const Tensor<1, 3> &x, const double side) {
  ClosestPoint result;
  result.position = foot.p;
  result.normal = side * dealii::cross_product_3d(foot.p_u, foot.p_v);
  result.normal /= result.normal.norm();
  result.gap = (x - foot.p) * result.normal;

  const double g_uu = foot.p_u * foot.p_u, g_uv = foot.p_u * foot.p_v, g_vv = foot.p_v * foot.p_v;
  const double b_uu = -(foot.p_uu * result.normal), b_uv = -(foot.p_uv * result.normal),
               b_vv = -(foot.p_vv * result.normal);
  const double m_uu = g_uu + result.gap * b_uu, m_uv = g_uv + result.gap * b_uv,
               m_vv = g_vv + result.gap * b_vv;
  const double det_g = g_uu * g_vv - g_uv * g_uv, det_m = m_uu * m_vv - m_uv * m_uv;
  if (std::abs(det_m) < 1e-14 * det_g)
    return result;
  const Tensor<1, 3> dual_u = (g_vv * foot.p_u - g_uv * foot.p_v) / det_g,
                     dual_v = (g_uu * foot.p_v - g_uv * foot.p_u) / det_g; // g⁻¹ Jᵀ
  const Tensor<1, 3> b_u = b_uu * dual_u + b_uv * dual_v, b_v = b_uv * dual_u + b_vv * dual_v;
  const Tensor<1, 3> t_u = (m_vv * b_u - m_uv * b_v) / det_m, t_v = (m_uu * b_v - m_uv * b_u) / det_m;
  result.turning = dealii::outer_product(foot.p_u, t_u) + dealii::outer_product(foot.p_v, t_v);
  return result;
}

namespace {

/// Returns the step of Newton's method in the free directions or, if that does not lead towards a
/// minimum, of steepest descent in the metric.
std::array<double, 2> choose_step(const SurfacePoint &here, const Tensor<1, 3> &arm,
                                  const std::array<bool, 2> &is_fixed, bool &is_newton) {
  const double slope_u = -(arm * here.p_u), slope_v = -(arm * here.p_v);
  const double g_uu = here.p_u * here.p_u, g_uv = here.p_u * here.p_v, g_vv = here.p_v * here.p_v;
  double h_uu = g_uu - arm * here.p_uu, h_uv = g_uv - arm * here.p_uv, h_vv = g_vv - arm * here.p_vv;
  constexpr double tiny = 1e-10;
  if (is_fixed[0] || is_fixed[1]) {
    const double metric = is_fixed[0] ? g_vv : g_uu, curved = is_fixed[0] ? h_vv : h_uu;
    is_newton = curved > tiny * metric;
    const double length =
        metric > 0. ? -(is_fixed[0] ? slope_v : slope_u) / (is_newton ? curved : metric) : 0.;
    return {is_fixed[0] ? 0. : length, is_fixed[0] && !is_fixed[1] ? length : 0.};
  }
  is_newton = h_uu > 0. && h_uu * h_vv - h_uv * h_uv > tiny * g_uu * g_vv;
  if (!is_newton) {
    h_uu = g_uu;
    h_uv = g_uv;
    h_vv = g_vv;
  }
  const double det = h_uu * h_vv - h_uv * h_uv;
  if (det < 1e-14 * h_uu * h_vv || det == 0.) // at a pole
    return {h_uu > 0. ? -slope_u / h_uu : 0., h_vv > 0. ? -slope_v / h_vv : 0.};
  return {-(h_vv * slope_u - h_uv * slope_v) / det, -(h_uu * slope_v - h_uv * slope_u) / det};
}

} // namespace

SurfaceFoot descend_to_foot(const std::function<SurfacePoint(double, double)> &surface,
                            const std::array<ParameterRange, 2> &ranges, const Tensor<1, 3> &x,
                            const double u, const double v) {
  std::array<double, 2> uv{u, v};
  std::array<bool, 2> is_fixed{false, false};
  std::array<bool, 2> has_wrapped{false, false};
  SurfacePoint here = surface(u, v);
  constexpr unsigned int max_steps = 60;
  for (unsigned int n = 0; n < max_steps; ++n) {
    const Tensor<1, 3> arm = x - here.p;
    const std::array<double, 2> slope{-(arm * here.p_u), -(arm * here.p_v)};
    for (unsigned int i = 0; i < 2; ++i) {
      const ParameterRange &range = ranges[i];
      const double downhill = slope[i] > 0. ? range.low : range.high;
      is_fixed[i] = !range.is_periodic && uv[i] == downhill && slope[i] != 0.;
      if (is_fixed[i] && range.is_closed && !has_wrapped[i]) {
        has_wrapped[i] = true;
        is_fixed[i] = false;
        uv[i] = slope[i] > 0. ? range.high : range.low;
        here = surface(uv[0], uv[1]);
      }
    }
    bool is_newton = true;
    const auto step = choose_step(here, x - here.p, is_fixed, is_newton);
    const double length = (step[0] * here.p_u + step[1] * here.p_v).norm();
    const double scale = here.p.norm() + (x - here.p).norm() + 1e-300;
    const double square = (x - here.p).norm_square();
    std::array<double, 2> next{};
    SurfacePoint there;
    bool is_clipped = false;
    for (double part = 1.; part > 1e-12; part *= 0.5) {
      is_clipped = false;
      for (unsigned int i = 0; i < 2; ++i) {
        next[i] = uv[i] + part * step[i];
        if (ranges[i].is_periodic || (next[i] >= ranges[i].low && next[i] <= ranges[i].high))
          continue;
        next[i] = std::clamp(next[i], ranges[i].low, ranges[i].high);
        is_clipped = true;
      }
      there = surface(next[0], next[1]);
      if (length < 1e-7 * scale || (x - there.p).norm_square() < square)
        break;
    }
    here = there;
    uv = next;
    // Newton's method doubles the number of correct digits.
    if (!is_clipped && length < (is_newton ? 1e-8 : 1e-13) * scale)
      break;
  }
  return {uv[0], uv[1], here, is_fixed[0] || is_fixed[1]};
}

SampledSurface::SampledSurface(Surface surface, const std::array<ParameterRange, 2> &ranges,
                               TriangleMesh mesh, std::vector<std::array<double, 2>> parameters)
    : surface_(std::move(surface)), ranges_(ranges), facets_(std::move(mesh)),
      parameters_(std::move(parameters)) {
  for (const auto &[u, v] : parameters_) {
    const SurfacePoint point = surface_(u, v);
    const double u_length = point.p_u.norm() * (ranges_[0].high - ranges_[0].low),
                 v_length = point.p_v.norm() * (ranges_[1].high - ranges_[1].low);
    poles_.push_back(u_length < 1e-6 * v_length ? 1 : v_length < 1e-6 * u_length ? 2 : 0);
  }
  constexpr double safety = 1.5; // factor on the samples' maximum deviation
  constexpr double third = 1. / 3.;
  constexpr std::array<std::array<double, 3>, 4> samples{
      {{third, third, third}, {0.5, 0.5, 0.}, {0., 0.5, 0.5}, {0.5, 0., 0.5}}};
  for (const auto &facet : facets_.mesh().facets)
    for (const auto &weights : samples) {
      Tensor<1, 3> flat;
      double u = 0., v = 0.;
      for (unsigned int i = 0; i < 3; ++i) {
        flat += weights[i] * facets_.mesh().points[facet[i]];
        u += weights[i] * parameters_[facet[i]][0];
        v += weights[i] * parameters_[facet[i]][1];
        facet_size_ =
            std::max(facet_size_,
                     (facets_.mesh().points[facet[(i + 1) % 3]] - facets_.mesh().points[facet[i]]).norm());
      }
      deviation_ = std::max(deviation_, safety * (surface_(u, v).p - flat).norm());
    }
}

SurfaceFoot SampledSurface::descend(const Tensor<1, 3> &x, const FacetTree::Foot &start) const {
  std::array<double, 2> uv{};
  unsigned char pole = 0;
  for (unsigned int i = 0; i < 3; ++i) {
    const unsigned int corner = mesh().facets[start.facet][i];
    for (unsigned int c = 0; c < 2; ++c)
      uv[c] += start.weights[i] * parameters_[corner][c];
    pole = std::max(pole, poles_[corner]);
  }
  if (pole > 0)
    uv = turn_about_pole(x, uv, pole - 1U);
  return descend_to_foot(surface_, ranges_, x, uv[0], uv[1]);
}

/// Improves the start near a pole, where facets give a poor estimate of the parameter `around` it:
/// takes that of the nearest of several points.
std::array<double, 2> SampledSurface::turn_about_pole(const Tensor<1, 3> &x, std::array<double, 2> uv,
                                                      const unsigned int around) const {
  constexpr unsigned int n = 24;
  const auto [low, high] = std::pair(ranges_[around].low, ranges_[around].high);
  double minimum = (x - surface_(uv[0], uv[1]).p).norm_square();
  auto best = uv;
  for (unsigned int i = 0; i < n; ++i) {
    uv[around] = low + (i + 0.5) / n * (high - low);
    const double square = (x - surface_(uv[0], uv[1]).p).norm_square();
    if (square < minimum) {
      minimum = square;
      best = uv;
    }
  }
  return best;
}

std::optional<SurfacePoint> SampledSurface::nearest(const Tensor<1, 3> &x,
                                                    const std::function<bool(const SurfaceFoot &)> &accept,
                                                    const std::function<double()> &edge_distance) const {
  std::optional<SurfacePoint> result;
  std::vector<Tensor<1, 3>> starts;
  double minimum = std::numeric_limits<double>::infinity();
  const auto try_from = [&](const FacetTree::Foot &start, const Tensor<1, 3> &position) {
    starts.push_back(position);
    const SurfaceFoot foot = descend(x, start);
    const double distance = (x - foot.point.p).norm();
    if (distance < minimum && accept(foot)) {
      result = foot.point;
      minimum = distance;
    }
  };
  const auto position_of = [this](const FacetTree::Foot &foot) {
    Tensor<1, 3> position;
    for (unsigned int i = 0; i < 3; ++i)
      position += foot.weights[i] * mesh().points[mesh().facets[foot.facet][i]];
    return position;
  };
  const auto nearest_facet = facets_.nearest(x);
  try_from(nearest_facet, position_of(nearest_facet));
  if (!result)
    minimum = edge_distance();
  double reach_square = std::pow(minimum + deviation_, 2);
  facets_.visit_near(x, reach_square, [&](const FacetTree::Foot &foot) {
    if (foot.square > reach_square)
      return;
    const Tensor<1, 3> position = position_of(foot);
    for (const auto &start : starts)
      if ((position - start).norm() < 1.5 * facet_size_)
        return;
    try_from(foot, position);
    reach_square = std::pow(minimum + deviation_, 2);
  });
  return result;
}

} // namespace billet
