// SPDX-License-Identifier: LGPL-2.1-or-later
// Closest point of a curved triangle.
#include "billet/geometry/curved_triangle.h"

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

/// Returns the change of the weight of corner i along (u, v).
double weight_change(const unsigned int i, const double u, const double v) {
  return i == 0 ? -u - v : i == 1 ? u : v;
}

double weight(const unsigned int i, const double u, const double v) {
  return i == 0 ? 1. - u - v : i == 1 ? u : v;
}

/// Direction of the edge opposite to corner i in (u, v).
constexpr std::array<std::array<double, 2>, 3> edge_direction{{{-1., 1.}, {0., 1.}, {1., 0.}}};

constexpr std::array<bool, 3> nowhere{false, false, false};

} // namespace

CurvedTriangle::Iterate CurvedTriangle::at(const Point &x, double u, double v,
                                           const std::array<bool, 3> &at) const {
  u = at[1] ? 0. : u;
  v = at[0] ? 1. - u : at[2] ? 0. : v;
  Iterate result{u, v, at, point_at(u, v), {}, 0.};
  result.arm = x - result.point.p;
  result.square = result.arm.norm_square();
  return result;
}

bool CurvedTriangle::has_one_minimum(const Point &x, const Shape &shape) const {
  constexpr double third = 1. / 3.;
  constexpr double safety = 0.9; // accounts for smaller values between the samples
  const SurfacePoint centre = quadratic_point_at(third, third);
  const Point arm = x - centre.p;
  const Matrix g = metric(centre), b = bending(arm, centre);
  double k = safety * shape.convexity;
  if (has_seams_)
    k -= shape.roughness / safety * std::abs(arm * up_);
  const double uu = k * g.uu - b.uu, uv = k * g.uv - b.uv, vv = k * g.vv - b.vv;
  return uu > 0. && uu * vv - uv * uv > 0.;
}

/// Returns the foot on the plane of the corners, moved into the triangle.
CurvedTriangle::Iterate CurvedTriangle::start_below(const Point &x) const {
  const Point a = u_ + uu_, b = v_ + vv_, arm = x - origin_; // along the chords
  const double aa = a * a, ab = a * b, bb = b * b, xa = arm * a, xb = arm * b;
  const double det = aa * bb - ab * ab;
  double u = (bb * xa - ab * xb) / det, v = (aa * xb - ab * xa) / det;
  std::array<bool, 3> edges = nowhere;
  if (u < 0. || v < 0. || u + v > 1.) {
    u = std::max(u, 0.);
    v = std::max(v, 0.);
    const double sum = std::max(1., u + v);
    u /= sum;
    v /= sum;
    edges = {sum > 1., u == 0., v == 0.};
  }
  return at(x, u, v, edges);
}

CurvedTriangle::Step CurvedTriangle::choose_step(const Iterate &here) {
  const Matrix g = metric(here.point), b = bending(here.arm, here.point);
  const Matrix newton{g.uu - b.uu, g.uv - b.uv, g.vv - b.vv};
  const double slope_u = -(here.arm * here.point.p_u), slope_v = -(here.arm * here.point.p_v);
  const auto leaves = [&here](const Step &step, const unsigned int except) {
    bool result = false;
    for (unsigned int i = 0; i < 3; ++i)
      result = result || (i != except && here.at[i] && weight_change(i, step.u, step.v) < 0.);
    return result;
  };

  // If no minimum is near, use the metric alone: a descent direction.
  Step step;
  step.is_newton = newton.uu > 0. && determinant(newton) > 1e-10 * g.uu * g.vv;
  const Matrix &h = step.is_newton ? newton : g;
  step.u = -(h.vv * slope_u - h.uv * slope_v) / determinant(h);
  step.v = -(h.uu * slope_v - h.uv * slope_u) / determinant(h);
  step.slope = slope_u * step.u + slope_v * step.v;
  if (!leaves(step, 3))
    return step;

  // The step would leave the triangle: take the best step along an edge, if there is one.
  Step best;
  best.is_possible = false;
  for (unsigned int i = 0; i < 3; ++i) {
    if (!here.at[i])
      continue;
    const auto [u, v] = edge_direction[i];
    const double slope = slope_u * u + slope_v * v;
    const double convex = newton.along(u, v), metric = g.along(u, v);
    Step edge;
    edge.is_newton = convex > 1e-10 * metric;
    const double length = -slope / (edge.is_newton ? convex : metric);
    edge.u = length * u;
    edge.v = length * v;
    edge.slope = slope * length;
    edge.along = i;
    if (!leaves(edge, i) && (!best.is_possible || edge.slope < best.slope))
      best = edge;
  }
  return best;
}

/// Descends by Newton's method with line search inside the triangle. At an edge it follows the edge
/// until descent inwards is possible again. It ends at a minimum over the triangle.
CurvedTriangle::Iterate CurvedTriangle::descend(const Point &x, Iterate here) const {
  constexpr unsigned int max_steps = 60;
  for (unsigned int n = 0; n < max_steps; ++n) {
    const Step step = choose_step(here);
    if (!step.is_possible)
      break;
    double part = 1.;
    std::array<bool, 3> edges = nowhere;
    if (step.along < 3)
      edges[step.along] = true;
    unsigned int hit = 3;
    for (unsigned int i = 0; i < 3; ++i) {
      const double change = weight_change(i, step.u, step.v);
      const double left = here.at[i] ? 0. : std::max(0., weight(i, here.u, here.v));
      if (!edges[i] && change < 0. && left + part * change < 0.) {
        part = left / -change;
        hit = i;
      }
    }
    const double maximum = std::max(std::abs(step.u), std::abs(step.v));
    const double round_off = 1e-15 * (1. + std::sqrt(here.square / here.point.p_u.norm_square()));
    // Newton's method doubles the number of correct digits.
    const bool is_last = hit == 3 && maximum < (step.is_newton ? 1e-8 : 1e-13) + round_off;
    Iterate next = here;
    for (unsigned int cut = 0; cut < 40; ++cut, part *= 0.5, hit = 3) {
      auto edges_there = edges;
      if (hit < 3)
        edges_there[hit] = true;
      next = at(x, here.u + part * step.u, here.v + part * step.v, edges_there);
      if (is_last || maximum * part < 1e-7 || next.square <= here.square + 2e-4 * part * step.slope)
        break;
    }
    here = next;
    if (is_last)
      break;
  }
  return here;
}

/// Returns the point at parameter t, from 0 to 1, of the edge opposite to corner i.
CurvedTriangle::Iterate CurvedTriangle::at_edge(const Point &x, const unsigned int i, const double t) const {
  constexpr std::array<unsigned int, 3> start{1, 0, 0}, end{2, 2, 1};
  std::array<bool, 3> edges{i == 0, i == 1, i == 2};
  if (t == 0. || t == 1.) {
    edges = {true, true, true};
    edges[t == 0. ? start[i] : end[i]] = false;
  }
  const auto [u, v] = edge_direction[i];
  return at(x, (i == 0 ? 1. : 0.) + t * u, t * v, edges);
}

/// Returns the nearest point of the edge opposite to corner i. The derivative of the squared
/// distance along it is cubic, and monotonic between the roots of its own derivative.
CurvedTriangle::Iterate CurvedTriangle::nearest_on_edge(const Point &x, const unsigned int i) const {
  const auto [u, v] = edge_direction[i];
  const double start = i == 0 ? 1. : 0.; // start value of u
  const Point arm = x - position(start, 0.);
  const Point b = u * (u_ + 2. * start * uu_) + v * (v_ + start * uv_);
  const Point c = u * (u * uu_ + v * uv_) + v * v * vv_;
  // p = ... + b t + c t²; a quarter of the derivative over t, with its own: k_0 + k_1 t + k_2 t² +
  // k_3 t³.
  const double k_0 = -0.5 * (arm * b), k_1 = 0.5 * (b * b) - arm * c, k_2 = 1.5 * (b * c), k_3 = c * c;
  const auto slope = [&](const double t) { return k_0 + t * (k_1 + t * (k_2 + t * k_3)); };
  std::array<double, 4> ends{0., 0., 0., 1.};
  const double turn = k_2 * k_2 - 3. * k_3 * k_1;
  if (turn > 0. && k_3 > 0.) {
    const double root = std::sqrt(turn);
    ends[1] = std::clamp((-k_2 - root) / (3. * k_3), 0., 1.);
    ends[2] = std::clamp((-k_2 + root) / (3. * k_3), 0., 1.);
  }
  Iterate best = at_edge(x, i, 0.);
  const auto consider = [&](const double t) {
    const Iterate other = at_edge(x, i, t);
    if (other.square < best.square)
      best = other;
  };
  for (unsigned int piece = 0; piece < 3; ++piece) {
    double low = ends[piece], high = ends[piece + 1];
    if (!(slope(low) < 0. && slope(high) > 0.)) // no minimum between
      continue;
    double t = 0.5 * (low + high);
    for (unsigned int n = 0; n < 60 && high - low > 1e-15; ++n) {
      // Newton's method, within the bracket.
      const double f = slope(t);
      (f < 0. ? low : high) = t;
      const double next = t - f / (k_1 + t * (2. * k_2 + 3. * t * k_3));
      const double step = std::abs(next - t);
      t = next > low && next < high ? next : 0.5 * (low + high);
      if (step < 1e-15)
        break;
    }
    consider(t);
  }
  consider(1.);
  return best;
}

/// Returns the least of the minima on the edges and of those reached from local minima of a grid.
CurvedTriangle::Iterate CurvedTriangle::descend_from_all(const Point &x) const {
  Iterate best = descend_once(x);
  const auto consider = [&](const Iterate &start) {
    const Iterate other = descend(x, start);
    if (other.square < best.square * (1. - 1e-14))
      best = other;
  };
  for (unsigned int i = 0; i < 3; ++i)
    consider(nearest_on_edge(x, i));

  constexpr int n = 8;
  std::array<std::array<double, n + 3>, n + 3> squares; // with a margin outside the triangle
  for (auto &row : squares)
    row.fill(std::numeric_limits<double>::infinity());
  for (int i = 0; i <= n; ++i)
    for (int j = 0; i + j <= n; ++j)
      squares[i + 1][j + 1] = (x - quadratic_point_at(double(i) / n, double(j) / n).p).norm_square();
  for (int i = 1; i <= n; ++i)
    for (int j = 1; i + j < n; ++j)
      if (squares[i + 1][j + 1] <= std::min({squares[i][j + 1], squares[i + 2][j + 1], squares[i + 1][j],
                                             squares[i + 1][j + 2], squares[i + 2][j], squares[i][j + 2]}))
        consider(at(x, double(i) / n, double(j) / n, nowhere));
  return best;
}

/// Descends first without F, which is small.
CurvedTriangle::Iterate CurvedTriangle::descend_once(const Point &x) const {
  if (!has_seams_)
    return descend(x, start_below(x));
  CurvedTriangle quadratic = *this;
  quadratic.has_seams_ = false;
  const Iterate start = quadratic.descend(x, quadratic.start_below(x));
  return descend(x, at(x, start.u, start.v, start.at));
}

ClosestPoint CurvedTriangle::closest_point(const Point &x, const Shape &shape) const {
  const Iterate foot = has_one_minimum(x, shape) ? descend_once(x) : descend_from_all(x);
  ClosestPoint result = at_foot(foot.point, x, 1.);
  const Point aside = foot.arm - result.gap * result.normal;
  const double length = std::sqrt(u_.norm_square() + v_.norm_square() + foot.square);
  result.is_beyond_edge = (foot.at[0] || foot.at[1] || foot.at[2]) && aside.norm() > 1e-10 * length;
  return result;
}

} // namespace billet
