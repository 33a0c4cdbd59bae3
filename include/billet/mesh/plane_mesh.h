// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MESH_PLANE_MESH_H
#define BILLET_MESH_PLANE_MESH_H

#include "billet/mesh/mesh_file.h"

namespace billet {

/// Replaces the quadrilaterals of a plane z = constant by one layer of hexahedra, as high as the
/// mesh is large and from z = 0 on. Their first four corners are those of the quadrilateral, in
/// turn about z, the others stand above these and have the same numbers. Groups of edges become
/// groups of faces, and sets of nodes get the nodes above. Throws std::invalid_argument if the mesh
/// has other elements or is not in such a plane.
void extrude_plane(MeshFile &mesh);

} // namespace billet

#endif
