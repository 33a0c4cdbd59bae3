// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_SURFACE_TYPE_H
#define BILLET_GEOMETRY_SURFACE_TYPE_H

#include "billet/geometry/surface_patch.h"
#include "billet/registered_type.h"

namespace billet {

/// Shape that a scene file can name.
using SurfaceType = RegisteredType<SurfacePatches>;

TypeTable<SurfacePatches> &surface_types();

/// Parameter common to many surfaces.
extern const TypeParameter side_parameter; ///< Side = outside|inside
double side_sign(const TypeInput &input);  ///< 1 or −1

} // namespace billet

#endif
