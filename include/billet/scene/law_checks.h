// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_LAW_CHECKS_H
#define BILLET_SCENE_LAW_CHECKS_H

#include "billet/scene/scene.h"

namespace billet {

/// Compares the tangents of users' laws with differences of their stresses, in scenes that need tangents.
/// Throws SolutionFailure if a law crashes.
DiagnosticList check_user_laws(const Scene &scene);

} // namespace billet

#endif
