// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/sector.h"

#include "billet/geometry/swept_profile.h"

#include <cmath>

namespace billet {

using Kind = TypeParameter::Kind;

std::vector<TypeParameter> with_sector(std::vector<TypeParameter> parameters) {
  parameters.push_back(
      {"Start", "1, 0, 0", Kind::text, "Direction across the axis at the start of the sector."});
  parameters.push_back({"Sector", "360", Kind::number,
                        "> 0 and <= 360. Angle of the sector, right-handed about the axis. [degrees]"});
  return parameters;
}

SurfacePatches revolve(const TypeInput &input, const Profile &profile, const dealii::Tensor<1, 3> &origin,
                       const dealii::Tensor<1, 3> &axis) {
  const double sector = input.number("Sector");
  if (!(sector > 0. && sector <= 360.))
    input.reject("Sector", "a number > 0 and <= 360");
  ProfileAxes axes(origin, axis);
  if (sector < 360.) {
    const auto start = input.direction("Start");
    if (dealii::cross_product_3d(start, axis).norm() < 1e-6)
      input.reject("Start", "a direction across the axis");
    axes = ProfileAxes(origin, axis, start);
  } else if (input.is_set("Start"))
    input.reject("Start", "no value: the surface goes all around");
  return single_patch<RevolvedProfile>(profile, axes, 0., sector * M_PI / 180.);
}

} // namespace billet
