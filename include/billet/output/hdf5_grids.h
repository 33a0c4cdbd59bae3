// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_HDF5_GRIDS_H
#define BILLET_OUTPUT_HDF5_GRIDS_H

#include "billet/output/grid.h"

#include <mpi.h>

#include <string>
#include <vector>

namespace billet {

/// Writes the grids of a snapshot into one HDF5 file, each into a group `block_0`, `block_1`, and
/// so on. Symmetric tensors have all nine components there. Returns the XDMF text that describes
/// the snapshot, on all ranks; empty if the file cannot be written. Collective.
std::string write_hdf5(MPI_Comm communicator, const std::string &folder, const std::string &file_name,
                       double time, const std::vector<std::string> &groups, const std::vector<Grid> &grids);

/// Returns the text of an XDMF file with these snapshots.
std::string xdmf_index(const std::string &snapshots);

} // namespace billet

#endif
