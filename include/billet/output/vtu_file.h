// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_VTU_FILE_H
#define BILLET_OUTPUT_VTU_FILE_H

#include "billet/output/grid.h"

#include <mpi.h>

#include <string>
#include <vector>

namespace billet {

/// Writes a grid as a VTU file with binary numbers. All ranks write into the one file. Returns
/// whether that succeeded, the same on all ranks. Collective.
bool write_vtu(MPI_Comm communicator, const std::string &file_name, const Grid &grid);

/// Grid of a snapshot and the name of its file.
struct GridFile {
  std::string group, name, file;
};

/// Returns the text of a VTM file, which gives the files their names as blocks. Every group of
/// `groups` is in it, empty or not.
std::string multiblock_index(const std::vector<std::string> &groups, const std::vector<GridFile> &files);

} // namespace billet

#endif
