// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_SECTOR_H
#define BILLET_GEOMETRY_SECTOR_H

#include "billet/geometry/profile.h"
#include "billet/geometry/surface_type.h"

namespace billet {

/// 'Start' and 'Sector', how far around its axis a surface of revolution goes, put at the end of
/// `parameters`.
std::vector<TypeParameter> with_sector(std::vector<TypeParameter> parameters);

/// The profile of points (radius, height) revolved about an `axis` (unit) through `origin` over the sector
/// that `input` asks for. Refuses what is no sector.
SurfacePatches revolve(const TypeInput &input, const Profile &profile, const dealii::Tensor<1, 3> &origin,
                       const dealii::Tensor<1, 3> &axis);

} // namespace billet

#endif
