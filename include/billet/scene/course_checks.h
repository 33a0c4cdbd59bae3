// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_COURSE_CHECKS_H
#define BILLET_SCENE_COURSE_CHECKS_H

#include "billet/diagnostics.h"
#include "billet/scene/scene.h"

namespace billet {

/// Warns of what the scene lets begin, fade or ramp up beyond its end time.
DiagnosticList check_course(const Scene &scene);

/// Warns of tools that a plane-strain or axisymmetric section does not allow: those whose gap differs along
/// the width, or around the axis, at the start, in the middle or at the end of their prescribed motion.
/// Collective.
DiagnosticList check_sections(const Scene &scene, const dealii::Triangulation<3> &mesh,
                              MPI_Comm communicator);

} // namespace billet

#endif
