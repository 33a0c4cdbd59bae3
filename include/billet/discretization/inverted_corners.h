// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_INVERTED_CORNERS_H
#define BILLET_DISCRETIZATION_INVERTED_CORNERS_H

#include "billet/diagnostics.h"
#include "billet/discretization/discretization.h"

namespace billet {

/// Returns a warning for each body with undeformed elements that are inverted at a corner. There
/// the edges span a negative volume, though the Jacobian may be positive at all Gauss points. A
/// corner with edges in one plane, as in a wedge, is not inverted. Collective.
DiagnosticList find_inverted_corners(const Scene &scene, const Discretization &discretization);
/// Returns a warning for each body with elements that are inverted at a corner after these
/// displacements. For the last state it is a different warning if they are more than a twentieth of
/// the body's elements. Elements have their `element_id` of field output. No formulation evaluates
/// corners, and hourglass modes invert them first.
///
/// The displacements have values at ghost nodes. Collective.
DiagnosticList find_inverted_corners(const Scene &scene, const Discretization &discretization,
                                     const Vector &displacements, bool is_last);

} // namespace billet

#endif
