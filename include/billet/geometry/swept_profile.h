// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_SWEPT_PROFILE_H
#define BILLET_GEOMETRY_SWEPT_PROFILE_H

#include "billet/geometry/profile.h"
#include "billet/geometry/surface_patch.h"

namespace billet {

/// Three orthonormal directions and an origin.
struct ProfileAxes {
  dealii::Tensor<1, 3> origin, x, y, z;

  /// Makes axes with z along `axis` (unit vector), x as close to `towards` as possible, and
  /// y = z × x.
  ProfileAxes(const dealii::Tensor<1, 3> &origin, const dealii::Tensor<1, 3> &axis,
              const dealii::Tensor<1, 3> &towards);
  /// Makes axes with z along `axis` and an arbitrary x orthogonal to it.
  ProfileAxes(const dealii::Tensor<1, 3> &origin, const dealii::Tensor<1, 3> &axis);

  dealii::Tensor<1, 3> from_origin(const double a, const double b, const double c) const {
    return origin + a * x + b * y + c * z;
  }
};

/// Profile of points (radius, height) revolved about the z axis. With the plane's gap g(ρ, z),
///   ∂²g/∂x² = ∂²g/∂(ρ, z)² + (1/ρ ∂g/∂ρ) e_φ⊗e_φ.
class RevolvedProfile final : public SurfacePatch {
public:
  /// Revolves the profile from the angle `from`, measured from the x axis, over `sweep` > 0
  /// [radians]; 2π or more is a full revolution. No point of the profile may have a negative
  /// radius.
  RevolvedProfile(Profile profile, const ProfileAxes &axes, double from = 0., double sweep = 2. * M_PI);

  ClosestPoint closest_point(const dealii::Tensor<1, 3> &x) const override;
  BoundingBox bounding_box() const override;
  void draw(const OutputRegion &region, SurfaceMesh &surface_mesh) const override;

private:
  Profile profile_;
  ProfileAxes axes_;
  double from_, sweep_;
  bool is_full_;
};

/// Profile of points (x, y) extruded along z.
class ExtrudedProfile final : public SurfacePatch {
public:
  /// Extrudes the profile from z = `low` to `high`, which may be infinite.
  ExtrudedProfile(Profile profile, const ProfileAxes &axes, double low, double high);

  ClosestPoint closest_point(const dealii::Tensor<1, 3> &x) const override;
  BoundingBox bounding_box() const override;
  void draw(const OutputRegion &region, SurfaceMesh &surface_mesh) const override;

private:
  Profile profile_;
  ProfileAxes axes_;
  double low_, high_;
};

} // namespace billet

#endif
