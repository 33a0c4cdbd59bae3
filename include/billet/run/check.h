// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_CHECK_H
#define BILLET_RUN_CHECK_H

#include "billet/discretization/discretization.h"

#include <iosfwd>

namespace billet {

/// Checks a scene by the code that a run executes before its first step, on the same mesh: throws
/// InputError if a run would. Otherwise the first rank describes the model, its SceneReport and the
/// warnings to `stream`, as text or as one JSON object. For a restart, it checks only the
/// checkpoint file and the meshes. Collective.
void check_simulation(const parameters::Scene &parameters, MPI_Comm communicator, std::ostream &stream,
                      bool as_json);

/// Checks a scene as check_simulation() does, without a description, and large meshes by their
/// outlines. Throws InputError. Collective.
void check_quietly(const parameters::Scene &parameters, MPI_Comm communicator);

/// Returns warnings about the undeformed meshes. Collective.
DiagnosticList check_meshes(const Scene &scene, const Discretization &discretization);

} // namespace billet

#endif
