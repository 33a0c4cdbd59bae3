// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/surface_type.h"

namespace billet {

SurfaceType plane_type();
SurfaceType rectangle_type();
SurfaceType disc_type();
SurfaceType sphere_type();
SurfaceType cylinder_type();
SurfaceType cone_type();
SurfaceType torus_type();
SurfaceType revolved_profile_type();
SurfaceType extruded_profile_type();
SurfaceType swept_profile_type();
SurfaceType coons_patch_type();
SurfaceType coons_patches_type();
SurfaceType stl_type();
SurfaceType cad_type();

TypeTable<SurfacePatches> &surface_types() {
  static TypeTable<SurfacePatches> types{plane_type(),
                                         rectangle_type(),
                                         disc_type(),
                                         sphere_type(),
                                         cylinder_type(),
                                         cone_type(),
                                         torus_type(),
                                         revolved_profile_type(),
                                         extruded_profile_type(),
                                         swept_profile_type(),
                                         coons_patch_type(),
                                         coons_patches_type(),
                                         stl_type(),
                                         cad_type()};
  return types;
}

const TypeParameter side_parameter{"Side", "outside", TypeParameter::Kind::choice,
                                   "outside|inside: Side of the bodies."};

double side_sign(const TypeInput &input) { return input.text("Side") == "outside" ? 1. : -1.; }

} // namespace billet
