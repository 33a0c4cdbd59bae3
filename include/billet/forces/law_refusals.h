// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FORCES_LAW_REFUSALS_H
#define BILLET_FORCES_LAW_REFUSALS_H

#include "billet/parameters/scene.h"

#include <mpi.h>

#include <string>

namespace billet {

/// Returns what a user's law says of its last, failed update, of the lowest rank with one; empty if
/// none failed. Throws SolutionFailure, on all ranks, if a law cannot go on, as after a crash.
/// Collective.
std::string find_law_refusal(const parameters::Scene &scene, MPI_Comm communicator);

/// Returns what a user's law says of its last, failed update; empty for others.
std::string describe_refusal(const PointLaw &law);

} // namespace billet

#endif
