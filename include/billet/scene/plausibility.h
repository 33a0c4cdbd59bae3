// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_PLAUSIBILITY_H
#define BILLET_SCENE_PLAUSIBILITY_H

#include "billet/diagnostics.h"
#include "billet/scene/scene.h"

namespace billet {

/// Returns warnings about inconsistent numbers, often due to mixed units. It checks yield stresses,
/// speeds, the durations of run and steps, travels and forces of tools, friction, and nodes that
/// start behind a tool. A tool with many turns gets a note.
///
/// All criteria are dimensionless ratios. `mesh`: all bodies or their outlines, on each rank its
/// cells. Collective.
DiagnosticList check_plausibility(const Scene &scene, const dealii::Triangulation<3> &mesh,
                                  MPI_Comm communicator);

/// Returns the force that a body bears on a section [force]. It is area times the flow stress at a
/// plastic strain of one. For an elastic body it is area times the stress at a strain of one.
double borne_force(const Body &body, double section);
/// Limits above which a tool force, relative to the borne force, and a number of explicit steps are
/// implausible.
constexpr double many_times_borne = 10., too_many_steps = 1e8;

/// Number and shape of the bricks through the thickness of a body, where it is thin.
struct ThinPart {
  /// Fraction of the boundary, where it can bend, below which the body is thin.
  double area = 0.;
  double mean_layers = 0.; ///< bricks through the thickness, mean over that area
  double mean_aspect = 0.; ///< longest edge along the face / brick's height, mean over that area
  double slenderness = 0.; ///< size of the body / mean thickness
};
/// Measures the thickness from each boundary face through opposite faces of bricks to the other
/// side. A part is thin if its thickness is below a tenth of the diagonal of the body's bounding
/// box. Faces that `holds` keep flat cannot bend and are left out.
ThinPart measure_thin_part(const dealii::Triangulation<3> &mesh, const std::vector<Constraint> &constraints);

/// Returns warnings about thin bodies whose elements may lock in bending, from their full meshes.
/// Very large bodies are left out. Serial.
DiagnosticList check_bricks(const Scene &scene);

} // namespace billet

#endif
