// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_LAW_MESSAGES_H
#define BILLET_RUN_LAW_MESSAGES_H

#include "billet/diagnostics.h"
#include "billet/scene/scene.h"

#include <mpi.h>

namespace billet {

/// Returns what material subroutines have said on all ranks since the last call; it costs nothing
/// in scenes without them. Collective.
DiagnosticList gather_law_messages(const Scene &scene, MPI_Comm communicator, double time);

} // namespace billet

#endif
