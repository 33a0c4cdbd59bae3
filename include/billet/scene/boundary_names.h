// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_BOUNDARY_NAMES_H
#define BILLET_SCENE_BOUNDARY_NAMES_H

#include "billet/error_notes.h"
#include "billet/mesh/boundary_groups.h"
#include "billet/parameters/scene.h"

#include <set>
#include <vector>

namespace billet {

/// Returns the least id, less one, that groups of a mesh file may get beside their numbers: more
/// than any id that the scene gives.
unsigned int min_new_id(const parameters::Mesh &mesh);

/// Parameters of a scene with the ids of all boundaries that it names, and what could not be
/// resolved.
struct ResolvedScene {
  parameters::Scene parameters;
  std::vector<BoundaryNames> names = {}; ///< of each body
  ErrorNotes errors = {};
  std::set<std::size_t> unsound_bodies = {}; ///< whose supports or loads name unknown boundaries
  bool has_meshes = true;                    ///< whether all mesh files could be read
};

/// Returns the scene with the ids of all boundaries that it names, and of all groups whose numbers
/// it has, or errors for unknown names. Reads mesh files.
ResolvedScene resolve_boundaries(parameters::Scene scene);

} // namespace billet

#endif
