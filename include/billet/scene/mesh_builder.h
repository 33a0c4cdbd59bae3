// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_MESH_BUILDER_H
#define BILLET_SCENE_MESH_BUILDER_H

#include "billet/mesh/boundary_groups.h"
#include "billet/mesh/mesh_checks.h"
#include "billet/mesh/mesh_volumes.h"
#include "billet/parameters/body.h"
#include "billet/scene/node_sets.h"

#include <deal.II/grid/tria.h>

namespace billet {

/// Level of detail of a mesh.
enum class MeshDetail {
  full,
  outline ///< no refinements, one layer: sufficient for boundary ids, extent and supports
};

/// Mesh of a file, checked and mended as the scene asks.
struct LoadedMesh {
  MeshFile mesh;
  BoundaryGroups groups;
  VolumeChoice volumes;
  NearNodes near_nodes;
};

/// Reads the mesh file of a body: of a section, as extrude_plane() makes it a layer. The first two
/// new ids of its groups are then those of both sides. Throws InputError.
LoadedMesh load_mesh_file(const parameters::Mesh &parameters);

/// Builds the mesh of one body. `sets`: if given, gets the node sets of its file. Throws
/// InputError.
void build_body_mesh(const parameters::Body &body, MeshDetail detail, dealii::Triangulation<3> &mesh,
                     NodeSets *sets = nullptr);

/// Whether the primitive of a mesh has curves, which refinement follows. Throws InputError.
bool has_curves(const parameters::Mesh &parameters);

/// Returns the number of elements of the full mesh, from its outline and the requested refinements.
std::size_t count_full_elements(const parameters::Mesh &parameters, const dealii::Triangulation<3> &outline);

/// Merges all bodies into one unrefined mesh, without shared nodes: cell material ids are the
/// indices of `meshes`, boundary ids are kept.
void merge_bodies(const std::vector<const dealii::Triangulation<3> *> &meshes,
                  dealii::Triangulation<3> &merged);

} // namespace billet

#endif
