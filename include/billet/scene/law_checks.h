// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_LAW_CHECKS_H
#define BILLET_SCENE_LAW_CHECKS_H

#include "billet/material/subroutine_messages.h"
#include "billet/scene/scene.h"

#include <vector>

namespace billet {

/// Compares the tangents of users' laws with differences of their stresses, in scenes that need
/// tangents. Throws SolutionFailure if a law crashes.
DiagnosticList check_user_laws(const Scene &scene);

/// Measures how much plastic work heats each body, and warns where units cannot fit each other.
DiagnosticList check_heating(const Scene &scene);

/// Warns of materials that are not symmetric about a symmetry plane of their body.
DiagnosticList check_mirrored_laws(const Scene &scene);

/// Returns the messages of material subroutines as messages of the program.
DiagnosticList describe(const std::vector<SubroutineMessage> &messages);

} // namespace billet

#endif
