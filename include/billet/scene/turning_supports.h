// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_TURNING_SUPPORTS_H
#define BILLET_SCENE_TURNING_SUPPORTS_H

#include "billet/diagnostics.h"
#include "billet/scene/scene.h"

#include <array>
#include <string>

namespace billet {

/// Returns the expressions of a support's displacement along its axes at the undeformed position.
/// They are those of the scene, unless the support holds radius and circumference of cylindrical
/// axes and turns. Then a node at the radius r moves to the radius r + u_r and turns by φ = u_θ / r
/// about the axis, (F8) of the theory. Along the undeformed directions that is (r + u_r) cos φ − r
/// and (r + u_r) sin φ.
std::array<std::string, 3> directed_displacement(const parameters::Support &support);

/// Warns of supports that prescribe large turns and leave the radius free: they move nodes along
/// tangents. `mesh`: all bodies or their outlines, on each rank its cells. Collective.
DiagnosticList check_turning_supports(const Scene &scene, const dealii::Triangulation<3> &mesh,
                                      MPI_Comm communicator);

} // namespace billet

#endif
