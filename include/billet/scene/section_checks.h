// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_SECTION_CHECKS_H
#define BILLET_SCENE_SECTION_CHECKS_H

#include "billet/diagnostics.h"
#include "billet/scene/scene.h"

namespace billet {

/// Warns of tools that a plane-strain or axisymmetric section does not allow. Their gap differs
/// along the width, or around the axis, at the start, in the middle or at the end of their
/// prescribed motion. Collective.
DiagnosticList check_tools_of_sections(const Scene &scene, const dealii::Triangulation<3> &mesh,
                                       MPI_Comm communicator);

/// Warns of loads of which a part leaves the section. Such parts are along the width of a layer,
/// around the axis of a wedge, or across the axis with one direction all around. Collective.
DiagnosticList check_loads_of_sections(const Scene &scene, const dealii::Triangulation<3> &mesh,
                                       MPI_Comm communicator);

} // namespace billet

#endif
