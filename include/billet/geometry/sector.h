// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_SECTOR_H
#define BILLET_GEOMETRY_SECTOR_H

#include "billet/geometry/profile.h"
#include "billet/geometry/surface_type.h"

namespace billet {

/// Appends 'Start' and 'Sector' to `parameters`: the angular range of a surface of revolution.
std::vector<TypeParameter> with_sector(std::vector<TypeParameter> parameters);

/// Revolves a profile of points (radius, height) about `axis` (unit vector) through `origin` over
/// the sector in `input`. Rejects invalid sectors.
SurfacePatches revolve(const TypeInput &input, const Profile &profile, const dealii::Tensor<1, 3> &origin,
                       const dealii::Tensor<1, 3> &axis);

} // namespace billet

#endif
