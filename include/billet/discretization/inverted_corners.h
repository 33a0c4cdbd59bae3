// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_INVERTED_CORNERS_H
#define BILLET_DISCRETIZATION_INVERTED_CORNERS_H

#include "billet/diagnostics.h"
#include "billet/discretization/discretization.h"

namespace billet {

/// A warning for each body with undeformed elements that are inside out at a corner: there the edges span a
/// negative volume, though it may be positive at all Gauss points. A corner whose edges lie in a plane, as of
/// a wedge, is none. Collective.
DiagnosticList find_inverted_corners(const Scene &scene, const Discretization &discretization);
/// The same of bodies with more than a twentieth of such elements after these displacements, which have
/// values at ghost nodes: no formulation sees a corner, and hourglass modes turn it around first. Collective.
DiagnosticList find_inverted_corners(const Scene &scene, const Discretization &discretization,
                                     const Vector &displacements);

} // namespace billet

#endif
