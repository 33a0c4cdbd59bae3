// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MESH_MESH_VOLUMES_H
#define BILLET_MESH_MESH_VOLUMES_H

#include "billet/mesh/mesh_file.h"

#include <string>
#include <vector>

namespace billet {

/// Volumes of a mesh file, and what one body takes of it.
struct VolumeChoice {
  std::vector<MeshVolume> volumes; ///< with members as the file has them
  std::vector<bool> is_taken;      ///< for each hexahedron of the file
};

/// Returns the name with which a scene names a volume.
std::string name_of(const MeshVolume &volume);

/// Keeps the hexahedra of the volumes with these names, or all if there are no names. Faces between
/// those and others become groups "interface" and "interface NAME", where NAME is a volume of the
/// others. A group of the file with this name keeps it for itself. Throws std::invalid_argument for
/// an unknown name.
VolumeChoice choose_volumes(MeshFile &mesh, const std::vector<std::string> &names);

/// Returns names of at least two volumes that the file means as bodies and that have no hexahedron
/// in common. Returns none if there are no two.
std::vector<std::string> separate_parts(const VolumeChoice &choice);

/// Hexahedra that no body takes.
struct UntakenVolumes {
  std::vector<std::string> names; ///< of volumes without a hexahedron that is taken
  std::size_t n_unnamed = 0;      ///< hexahedra that are in no volume
};

/// Returns what remains after the choices of several bodies from one file.
UntakenVolumes find_untaken(const std::vector<VolumeChoice> &choices);

} // namespace billet

#endif
