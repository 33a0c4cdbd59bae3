// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_MESH_SIZES_H
#define BILLET_RUN_MESH_SIZES_H

#include "billet/parameters/body.h"

#include <map>

namespace billet {

/// Sizes of a body that its mesh has.
struct MeshSizes {
  double volume = 0.;                   ///< [length³]
  std::map<unsigned int, double> areas; ///< by boundary id [length²]

  /// Builds the whole mesh. Throws InputError.
  static MeshSizes of(const parameters::Body &body);
};

/// Whether sizes are as near to those of the given mesh as to those of the mesh before, whose
/// elements are twice as large. They are where all meshes show the same body. A groove that only
/// nodes of the given mesh have is in the sizes of that mesh alone.
bool approach(const MeshSizes &before, const MeshSizes &now, const MeshSizes &given);

} // namespace billet

#endif
