// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_CAPABILITIES_FILE_H
#define BILLET_OUTPUT_CAPABILITIES_FILE_H

#include "billet/diagnostics.h"

#include <deal.II/base/mpi.h>

#include <string>

namespace billet {

/// Writes capabilities.csv into the folder: calls of its loops, items in them and peak memory
/// [bytes] of each capability. Items and memory are summed over ranks; calls are the maximum.
/// Returns a message on the first rank if it cannot write. Collective.
DiagnosticList write_capabilities(const std::string &folder, MPI_Comm communicator);

} // namespace billet

#endif
