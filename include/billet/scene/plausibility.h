// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_PLAUSIBILITY_H
#define BILLET_SCENE_PLAUSIBILITY_H

#include "billet/diagnostics.h"
#include "billet/scene/scene.h"

namespace billet {

/// Returns warnings about numbers that do not fit each other, most often since units are mixed: yield
/// stresses, speeds, the length of the run and of steps, travels and forces of tools, friction, and nodes
/// that start behind a tool; a note where a tool turns often. All are ratios; none has a unit. `mesh`: of all
/// bodies, or of their outlines, each rank its cells. Collective.
DiagnosticList check_plausibility(const Scene &scene, const dealii::Triangulation<3> &mesh,
                                  MPI_Comm communicator);

/// What the largest section of a body bears as it yields at a strain of one, or, of an elastic body, as it is
/// strained that much [force].
double borne_force(const Body &body, double section);
/// Beyond these a force of a tool, and a number of explicit steps, are implausible.
constexpr double many_times_borne = 10., too_many_steps = 1e8;

/// How many bricks a body has through its thickness, and their shape, where it is thin.
struct ThinPart {
  double area = 0.;        ///< part of the boundary that can bend below which the body is thin
  double mean_layers = 0.; ///< bricks through the thickness, mean over that area
  double mean_aspect = 0.; ///< longest edge along the face / brick's height, mean over that area
  double slenderness = 0.; ///< size of the body / mean thickness
};
/// From each boundary face through opposite faces of bricks to the other side; thin is what has less than a
/// tenth of the diagonal of the box around the body. What `holds` keep flat cannot bend, and is left out.
ThinPart measure_thin_part(const dealii::Triangulation<3> &mesh, const std::vector<Hold> &holds);

/// Returns warnings about thin bodies whose elements may lock in bending, from their full meshes. Bodies of
/// very many elements are left out. Serial.
DiagnosticList check_bricks(const Scene &scene);

} // namespace billet

#endif
