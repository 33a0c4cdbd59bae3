// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/curved_triangle.h"

#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

/// Function of (u, v) with its derivatives.
struct Jet {
  double f, u, v, uu = 0., uv = 0., vv = 0.;
};

Jet operator+(const Jet &a, const Jet &b) {
  return {a.f + b.f, a.u + b.u, a.v + b.v, a.uu + b.uu, a.uv + b.uv, a.vv + b.vv};
}

Jet operator*(const Jet &a, const Jet &b) {
  return {a.f * b.f,
          a.u * b.f + a.f * b.u,
          a.v * b.f + a.f * b.v,
          a.uu * b.f + 2. * a.u * b.u + a.f * b.uu,
          a.uv * b.f + a.u * b.v + a.v * b.u + a.f * b.uv,
          a.vv * b.f + 2. * a.v * b.v + a.f * b.vv};
}

Jet operator/(const Jet &a, const Jet &b) {
  const double inverse = 1. / b.f;
  Jet q{a.f * inverse, 0., 0.};
  q.u = (a.u - q.f * b.u) * inverse;
  q.v = (a.v - q.f * b.v) * inverse;
  q.uu = (a.uu - 2. * q.u * b.u - q.f * b.uu) * inverse;
  q.uv = (a.uv - q.u * b.v - q.v * b.u - q.f * b.uv) * inverse;
  q.vv = (a.vv - 2. * q.v * b.v - q.f * b.vv) * inverse;
  return q;
}

/// Returns α + β (λ_j − λ_i).
Jet linear(const CurvedTriangle::Seam &seam, const Jet &i, const Jet &j) {
  const double a = seam.alpha, b = seam.beta;
  return {a + b * (j.f - i.f), b * (j.u - i.u), b * (j.v - i.v)};
}

/// Returns F. At the corners its second derivatives depend on the direction; there they are set to
/// zero.
Jet turning_part(const std::array<CurvedTriangle::Seam, 3> &seams, const double u, const double v) {
  const Jet l_0{1. - u - v, -1., -1.}, l_1{u, 1., 0.}, l_2{v, 0., 1.};
  const Jet l_01 = l_0 * l_1, l_12 = l_1 * l_2, l_20 = l_2 * l_0;
  const Jet sum = l_01 + l_12 + l_20;
  if (std::abs(sum.f) < 1e-12)
    return {0., 0., 0.};
  const Jet lines = l_01 * linear(seams[0], l_0, l_1) + l_12 * linear(seams[1], l_1, l_2) +
                    l_20 * linear(seams[2], l_2, l_0);
  return l_01 * l_2 * lines / sum;
}

} // namespace

CurvedTriangle::CurvedTriangle(const std::array<Point, 3> &corners, const std::array<Point, 3> &bends,
                               const std::array<Seam, 3> &seams)
    : origin_(corners[0]), u_(corners[1] - corners[0] - bends[0]), v_(corners[2] - corners[0] - bends[2]),
      uu_(bends[0]), uv_(bends[0] + bends[2] - bends[1]), vv_(bends[2]), seams_(seams) {
  for (const Seam &seam : seams)
    has_seams_ = has_seams_ || seam.alpha != 0.F || seam.beta != 0.F;
  if (has_seams_)
    up_ = dealii::cross_product_3d(Point(corners[1] - corners[0]), Point(corners[2] - corners[0]));
}

/// Returns the point without F.
SurfacePoint CurvedTriangle::quadratic_point_at(const double u, const double v) const {
  return {origin_ + u * (u_ + u * uu_ + v * uv_) + v * (v_ + v * vv_),
          u_ + 2. * u * uu_ + v * uv_,
          v_ + 2. * v * vv_ + u * uv_,
          2. * uu_,
          uv_,
          2. * vv_};
}

SurfacePoint CurvedTriangle::point_at(const double u, const double v) const {
  SurfacePoint point = quadratic_point_at(u, v);
  if (!has_seams_)
    return point;
  const Jet f = turning_part(seams_, u, v);
  point.p += f.f * up_;
  point.p_u += f.u * up_;
  point.p_v += f.v * up_;
  point.p_uu += f.uu * up_;
  point.p_uv += f.uv * up_;
  point.p_vv += f.vv * up_;
  return point;
}

CurvedTriangle::Point CurvedTriangle::area_normal(const double u, const double v) const {
  const SurfacePoint point = point_at(u, v);
  return dealii::cross_product_3d(point.p_u, point.p_v);
}

/// Returns an upper bound of |F|: w u v is at most 1/27, and the other factor is a mean of the l.
double CurvedTriangle::max_turning_part() const {
  double maximum = 0.;
  for (const Seam &seam : seams_)
    maximum = std::max(maximum, std::abs(double(seam.alpha)) + std::abs(double(seam.beta)));
  return maximum / 27.;
}

bool CurvedTriangle::is_farther(const Point &x, const double square) const {
  constexpr double third = 1. / 3.;
  // `view` is from near the centroid.
  const Point arm = x - origin_, view = arm - third * (u_ + v_) - third * third * (uu_ + uv_ + vv_);
  // Control points relative to the first corner.
  const double u = u_ * view, v = v_ * view, uu = uu_ * view, uv = uv_ * view, vv = vv_ * view;
  double farthest = std::max({0., 0.5 * u, 0.5 * v, u + uu, v + vv, 0.5 * (u + v + uv)});
  if (has_seams_)
    farthest += max_turning_part() * std::abs(up_ * view);
  const double minimum = arm * view - farthest;
  return minimum > 0. && minimum * minimum > square * view.norm_square() * (1. + 1e-12);
}

BoundingBox CurvedTriangle::bounding_box() const {
  BoundingBox box = BoundingBox::empty();
  for (const Point &control : {origin_, origin_ + u_ + uu_, origin_ + v_ + vv_, origin_ + 0.5 * u_,
                               origin_ + 0.5 * v_, origin_ + 0.5 * (u_ + v_ + uv_)}) {
    box.add(control);
    if (has_seams_) {
      box.add(control + max_turning_part() * up_);
      box.add(control - max_turning_part() * up_);
    }
  }
  return box;
}

CurvedTriangle::Shape CurvedTriangle::shape() const {
  constexpr double third = 1. / 3.;
  const SurfacePoint centre = quadratic_point_at(third, third);
  const Matrix g = metric(centre);
  const double det_g = determinant(g);
  // Roots k of det(m − k g) = 0.
  const auto roots = [&](const Matrix &m) {
    const double half = 0.5 * (m.uu * g.vv + m.vv * g.uu - 2. * m.uv * g.uv);
    const double root = std::sqrt(std::max(0., half * half - det_g * determinant(m)));
    return std::array<double, 2>{(half - root) / det_g, (half + root) / det_g};
  };
  Shape result{1.F, 0.F};
  // Approach the corners from both sides: F's second derivatives depend on the direction there.
  constexpr double in = 1e-3;
  constexpr unsigned int n_samples = 16;
  constexpr std::array<std::array<double, 2>, n_samples> samples{{{0., 0.},
                                                                  {1., 0.},
                                                                  {0., 1.},
                                                                  {0.5, 0.5},
                                                                  {0., 0.5},
                                                                  {0.5, 0.},
                                                                  {third, third},
                                                                  {in, 0.},
                                                                  {0., in},
                                                                  {in, in},
                                                                  {1. - in, 0.},
                                                                  {1. - in, in},
                                                                  {1. - 2. * in, in},
                                                                  {0., 1. - in},
                                                                  {in, 1. - in},
                                                                  {in, 1. - 2. * in}}};
  for (const auto &[u, v] : samples) {
    const SurfacePoint here = point_at(u, v);
    const Matrix m = metric(here), b = bending(here.p - centre.p, here);
    result.convexity =
        std::min(result.convexity, static_cast<float>(roots({m.uu + b.uu, m.uv + b.uv, m.vv + b.vv})[0]));
    if (has_seams_) {
      const Jet f = turning_part(seams_, u, v);
      for (const double root : roots({f.uu, f.uv, f.vv}))
        result.roughness = std::max(result.roughness, static_cast<float>(std::abs(root)));
    }
  }
  return result;
}

} // namespace billet
