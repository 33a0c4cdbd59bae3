// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_COURSE_CHECKS_H
#define BILLET_SCENE_COURSE_CHECKS_H

#include "billet/diagnostics.h"
#include "billet/scene/scene.h"

namespace billet {

/// Warns of what the scene lets begin, fade or ramp up beyond its end time.
DiagnosticList check_course(const Scene &scene);

} // namespace billet

#endif
