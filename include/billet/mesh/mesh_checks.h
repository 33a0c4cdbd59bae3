// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MESH_MESH_CHECKS_H
#define BILLET_MESH_MESH_CHECKS_H

#include "billet/mesh/mesh_file.h"

namespace billet {

/// What becomes of nodes at the same place, which belong to different elements.
enum class DoubledNodes {
  refused,
  kept, ///< a slit, or parts that only touch
  merged
};

/// Removes nodes that no hexahedron uses. Merges nodes within `distance` of each other, if they are to be
/// merged. Turns all hexahedra inside out if all are inverted. Throws std::invalid_argument that names
/// collapsed, repeated and inverted elements and doubled nodes by their numbers in the file.
void mend_and_check(MeshFile &mesh, DoubledNodes doubled, double distance);

} // namespace billet

#endif
