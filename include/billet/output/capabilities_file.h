// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_CAPABILITIES_FILE_H
#define BILLET_OUTPUT_CAPABILITIES_FILE_H

#include <deal.II/base/mpi.h>

#include <string>

namespace billet {

/// Writes capabilities.csv into the folder: of each capability how often its loops ran, over how many items,
/// and how many bytes it held at most, summed over ranks (calls: of the rank that has most). Where the first
/// rank cannot write, the run goes on. Collective.
void write_capabilities(const std::string &folder, MPI_Comm communicator);

} // namespace billet

#endif
