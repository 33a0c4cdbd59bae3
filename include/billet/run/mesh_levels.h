// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_MESH_LEVELS_H
#define BILLET_RUN_MESH_LEVELS_H

#include "billet/parameters/scene.h"

#include <vector>

namespace billet {

/// Returns how many times every mesh of the scene can be made coarser by a factor of two, at most
/// `most` times. A level has fewer 'Refinements', or, of a subdivided box, half the numbers of
/// elements where these are even. A single element across a body remains one on all levels if
/// symmetry planes hold both of its sides. Else the mesh cannot be made coarser: its levels would
/// be no family, and have no order of convergence.
unsigned int count_coarser_levels(const parameters::Scene &scene, unsigned int most);

/// Returns the scene with meshes of other levels, one for each body: elements of 2^−level times the
/// size. A negative level is at least −count_coarser_levels().
parameters::Scene at_mesh_levels(const parameters::Scene &scene, const std::vector<int> &levels);

} // namespace billet

#endif
