// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/swept_profile.h"

#include "billet/geometry/frame.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Maximum angles of facets that represent an arc, whose chords are up to 0.015 % and 0.1 % of its
/// radius away from it. The coarse one is for surfaces that would have more facets otherwise.
struct FacetAngles {
  static constexpr double fine = M_PI / 90., coarse = M_PI / 36.;
  static constexpr std::size_t max_facets = 10000;
};

/// Returns a b, where 0 times infinity is 0.
double product(const double a, const double b) { return std::abs(a) < 1e-14 ? 0. : a * b; }

/// Adds quadrilaterals between adjacent rows of points.
void add_grid(const std::vector<std::vector<Tensor<1, 3>>> &rows, SurfaceMesh &surface_mesh) {
  const auto first = static_cast<unsigned int>(surface_mesh.points.size());
  const auto n = static_cast<unsigned int>(rows.front().size());
  for (const auto &row : rows)
    surface_mesh.points.insert(surface_mesh.points.end(), row.begin(), row.end());
  for (unsigned int i = 0; i + 1 < rows.size(); ++i)
    for (unsigned int j = 0; j + 1 < n; ++j) {
      const unsigned int corner = first + i * n + j;
      surface_mesh.facets.push_back({corner, corner + 1, corner + n + 1, corner + n});
    }
}

} // namespace

ProfileAxes::ProfileAxes(const Tensor<1, 3> &origin, const Tensor<1, 3> &axis, const Tensor<1, 3> &towards)
    : origin(origin), z(axis) {
  x = towards - (towards * axis) * axis;
  x /= x.norm();
  y = dealii::cross_product_3d(z, x);
}

ProfileAxes::ProfileAxes(const Tensor<1, 3> &origin, const Tensor<1, 3> &axis)
    : ProfileAxes(origin, axis, Frame::from_normal(axis).q) {}

RevolvedProfile::RevolvedProfile(Profile profile, const ProfileAxes &axes, const double from,
                                 const double sweep)
    : profile_(std::move(profile)), axes_(axes), from_(from), sweep_(sweep), is_full_(sweep >= 2. * M_PI) {}

ClosestPoint RevolvedProfile::closest_point(const Tensor<1, 3> &x) const {
  const Tensor<1, 3> arm = x - axes_.origin;
  const double height = arm * axes_.z;
  const double a = arm * axes_.x, b = arm * axes_.y;
  double radius = std::hypot(a, b);
  // On the axis the direction is arbitrary; here the surface may be oblique to the axis.
  constexpr double oblique = 1e-6;
  const double tiny = 1e-14 * (profile_.size() + std::abs(height));
  Tensor<1, 3> outwards = radius > tiny ? (a * axes_.x + b * axes_.y) / radius : axes_.x;
  bool is_beside = false;
  if (!is_full_) {
    double turned = std::atan2(b, a) - from_;
    turned -= 2. * M_PI * std::floor(turned / (2. * M_PI));
    if (radius <= tiny || turned > sweep_) {
      // Project onto the nearer one of the two bounding half-planes, in which the point may have a
      // negative radius.
      const double to_start = 2. * M_PI - turned, to_end = turned - sweep_;
      const double angle = radius > tiny && to_end < to_start ? from_ + sweep_ : from_;
      outwards = std::cos(angle) * axes_.x + std::sin(angle) * axes_.y;
      radius = arm * outwards;
      is_beside = std::abs(arm * dealii::cross_product_3d(axes_.z, outwards)) > 1e-10 * profile_.size();
    }
  }

  const Profile::Closest closest = profile_.closest_point(Profile::Point({radius, height}));
  ClosestPoint result;
  result.position = axes_.origin + closest.position[0] * outwards + closest.position[1] * axes_.z;
  result.normal = closest.normal[0] * outwards + closest.normal[1] * axes_.z;
  result.gap = closest.gap;
  result.is_beyond_edge = closest.is_beyond_edge || is_beside;
  if (is_full_ && radius <= tiny && closest.gap < 0. && !closest.is_beyond_edge &&
      std::abs(closest.normal[1]) > oblique) { // at a tip: the mean of all directions
    result.normal = std::copysign(1., closest.normal[1]) * axes_.z;
    result.position = x - result.gap * result.normal;
  }
  const Tensor<1, 3> along = -closest.normal[1] * outwards + closest.normal[0] * axes_.z;
  const Tensor<1, 3> around = dealii::cross_product_3d(axes_.z, outwards);
  // Near the axis both principal curvatures are equal.
  const double around_turning =
      std::abs(radius) > 1e-9 * profile_.size() ? closest.normal[0] / radius : closest.turning;
  result.turning = closest.turning * dealii::outer_product(along, along) +
                   around_turning * dealii::outer_product(around, around);
  return result;
}

BoundingBox RevolvedProfile::bounding_box() const {
  BoundingBox box = BoundingBox::empty();
  for (unsigned int i = 0; i < 3; ++i) {
    const double up = axes_.z[i], across = std::sqrt(std::max(0., 1. - up * up));
    box.high[i] = axes_.origin[i] + profile_.support(Profile::Point({across, up}));
    box.low[i] = axes_.origin[i] - profile_.support(Profile::Point({across, -up}));
  }
  return box;
}

void RevolvedProfile::draw(const OutputRegion &region, SurfaceMesh &surface_mesh) const {
  const Tensor<1, 3> arm = region.centre - axes_.origin;
  const double height = arm * axes_.z;
  const double reach = (arm - height * axes_.z).norm() + region.radius;
  const double sweep = std::min(sweep_, 2. * M_PI);
  const auto profile = [&](const double angle) {
    return profile_.polyline(angle, Profile::Point({0., height}), reach);
  };
  auto points = profile(FacetAngles::fine);
  auto n = static_cast<unsigned int>(std::ceil(sweep / FacetAngles::fine));
  if (n * points.size() > FacetAngles::max_facets) {
    points = profile(FacetAngles::coarse);
    n = static_cast<unsigned int>(std::ceil(sweep / FacetAngles::coarse));
  }
  std::vector<std::vector<Tensor<1, 3>>> rows(n + 1);
  for (unsigned int i = 0; i <= n; ++i) {
    const double angle = from_ + i * sweep / n;
    const Tensor<1, 3> outwards = std::cos(angle) * axes_.x + std::sin(angle) * axes_.y;
    for (const auto &point : points)
      rows[i].push_back(axes_.origin + point[0] * outwards + point[1] * axes_.z);
  }
  add_grid(rows, surface_mesh);
}

ExtrudedProfile::ExtrudedProfile(Profile profile, const ProfileAxes &axes, const double low,
                                 const double high)
    : profile_(std::move(profile)), axes_(axes), low_(low), high_(high) {}

ClosestPoint ExtrudedProfile::closest_point(const Tensor<1, 3> &x) const {
  const Tensor<1, 3> arm = x - axes_.origin;
  const double z = arm * axes_.z, inside = std::clamp(z, low_, high_);
  const Profile::Closest closest = profile_.closest_point(Profile::Point({arm * axes_.x, arm * axes_.y}));
  ClosestPoint result;
  result.position = axes_.from_origin(closest.position[0], closest.position[1], inside);
  result.normal = closest.normal[0] * axes_.x + closest.normal[1] * axes_.y;
  result.gap = closest.gap;
  result.is_beyond_edge = closest.is_beyond_edge || std::abs(z - inside) > 1e-10 * profile_.size();
  const Tensor<1, 3> along = -closest.normal[1] * axes_.x + closest.normal[0] * axes_.y;
  result.turning = closest.turning * dealii::outer_product(along, along);
  return result;
}

BoundingBox ExtrudedProfile::bounding_box() const {
  BoundingBox box;
  for (unsigned int i = 0; i < 3; ++i) {
    const Profile::Point direction({axes_.x[i], axes_.y[i]});
    const double up = axes_.z[i];
    box.high[i] =
        axes_.origin[i] + profile_.support(direction) + std::max(product(up, low_), product(up, high_));
    box.low[i] =
        axes_.origin[i] - profile_.support(-direction) + std::min(product(up, low_), product(up, high_));
  }
  return box;
}

void ExtrudedProfile::draw(const OutputRegion &region, SurfaceMesh &surface_mesh) const {
  const Tensor<1, 3> arm = region.centre - axes_.origin;
  const Profile::Point centre({arm * axes_.x, arm * axes_.y});
  const double z = arm * axes_.z;
  const auto points = profile_.polyline(FacetAngles::fine, centre, region.radius);
  const double low = low_ == -infinity ? std::min(z - region.radius, high_) : low_;
  const double high = high_ == infinity ? std::max(z + region.radius, low) : high_;
  std::vector<std::vector<Tensor<1, 3>>> rows(2);
  for (const auto &point : points) {
    rows[0].push_back(axes_.from_origin(point[0], point[1], low));
    rows[1].push_back(axes_.from_origin(point[0], point[1], high));
  }
  add_grid(rows, surface_mesh);
}

} // namespace billet
