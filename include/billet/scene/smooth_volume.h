// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_SMOOTH_VOLUME_H
#define BILLET_SCENE_SMOOTH_VOLUME_H

#include "billet/parameters/body.h"

#include <optional>

namespace billet {

/// Returns the volume that the mesh of a body tends to as it is refined, extrapolated from two
/// coarser meshes. For a polyhedron that stands for a ball, it is the volume of the ball. The sides
/// of a wedge count as flat, as in its bricks. Returns none for a mesh file, whose true shape is
/// unknown, for a shape without curves, and for too many elements before refinement.
std::optional<double> find_smooth_volume(const parameters::Body &body);

} // namespace billet

#endif
