// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MESH_MESH_CHECKS_H
#define BILLET_MESH_MESH_CHECKS_H

#include "billet/mesh/mesh_file.h"

namespace billet {

/// Treatment of nodes at the same place, which belong to different elements.
enum class DoubledNodes {
  refused,
  kept, ///< a slit, or parts that only touch
  merged
};

/// Pairs of nodes that are closer than a thousandth of the edges there, but not at the same place.
struct NearNodes {
  std::size_t n_pairs = 0;
  double distance = 0.;      ///< maximum of these pairs
  std::string examples = {}; ///< numbers of the nodes in the file
};

/// Removes nodes that no hexahedron uses. Merges nodes within `distance` of each other, if they are
/// to be merged. Turns all hexahedra inside out if all are inverted. Throws std::invalid_argument
/// that names collapsed, repeated and inverted elements and doubled nodes by their numbers in the
/// file. Returns nodes that are probably doubled, unless doubled nodes are kept.
NearNodes mend_and_check(MeshFile &mesh, DoubledNodes doubled, double distance);

} // namespace billet

#endif
