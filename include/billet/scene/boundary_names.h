// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_BOUNDARY_NAMES_H
#define BILLET_SCENE_BOUNDARY_NAMES_H

#include "billet/mesh/boundary_groups.h"
#include "billet/parameters/scene.h"

#include <vector>

namespace billet {

/// Returns the least id, less one, that groups of a mesh file may get beside their numbers: more than any id
/// that the scene gives.
unsigned int least_new_id(const parameters::Mesh &mesh);

/// Returns the scene with the ids of all boundaries that it names, and of all groups whose numbers it has.
/// `names`: those of each body. Reads mesh files. Throws InputError for unknown names.
parameters::Scene resolve_boundaries(parameters::Scene scene, std::vector<BoundaryNames> &names);

} // namespace billet

#endif
