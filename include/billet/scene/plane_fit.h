// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_PLANE_FIT_H
#define BILLET_SCENE_PLANE_FIT_H

#include "billet/parameters/body.h"

#include <deal.II/grid/tria.h>

namespace billet {

/// Moves the vertices of boundary faces that are nearly on a symmetry plane onto it. Thus the plane
/// holds the whole side of a mesh with few digits. A face is nearly on the plane if its vertices
/// are nearer to it than a thousandth of the depth of their element. `mesh` has one level.
///
/// Throws InputError if a face beside such a side is off the plane by up to a hundredth of that
/// depth. Such a face would be free.
void fit_to_planes(const parameters::Body &body, dealii::Triangulation<3> &mesh);

/// Returns words about the boundary face nearest to a plane: its centre, and how far its vertices
/// are off.
std::string describe_nearest_face(const parameters::SymmetryPlane &plane,
                                  const dealii::Triangulation<3> &mesh, unsigned int body);

} // namespace billet

#endif
