// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_MESH_BUILDER_H
#define BILLET_SCENE_MESH_BUILDER_H

#include "billet/parameters/body.h"

#include <deal.II/grid/tria.h>

namespace billet {

/// How much of a mesh to build.
enum class MeshDetail {
  full,
  outline ///< no refinements, one layer: enough for its boundary ids, its extent and its supports
};

/// Builds the mesh of one body. Throws InputError.
void build_body_mesh(const parameters::Body &body, MeshDetail detail, dealii::Triangulation<3> &mesh);

/// Elements that the full mesh will have, from its outline and the refinements asked for.
std::size_t count_full_elements(const parameters::Mesh &parameters, const dealii::Triangulation<3> &outline);

/// All bodies side by side in one unrefined mesh, without shared nodes: cell material ids are the indices of
/// `meshes`, boundary ids are kept.
void merge_bodies(const std::vector<const dealii::Triangulation<3> *> &meshes,
                  dealii::Triangulation<3> &merged);

} // namespace billet

#endif
