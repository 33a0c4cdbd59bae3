// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_FIELD_WRITER_H
#define BILLET_OUTPUT_FIELD_WRITER_H

#include "billet/output/grid.h"
#include "billet/solve/solution.h"
#include "billet/state.h"

#include <string>
#include <vector>

namespace billet {

/// Field output for ParaView: the blocks of make_snapshot_grids(), as VTU or HDF5. An index file
/// lists all snapshots. It is rewritten with each snapshot, so that results of an interrupted run
/// remain readable. A script beside it shows them in ParaView.
class FieldWriter {
public:
  FieldWriter(const Scene &scene, MPI_Comm communicator, std::string folder);

  /// Writes a snapshot. Collective.
  void write(const Solution &solution);
  /// Writes these blocks as a preview, which the script beside them shows with its groups.
  /// Collective.
  void write_preview(const Solution &solution, const std::vector<Grid> &grids);

  /// Saves and restores the list of snapshots, so that a resumed run continues the files in the
  /// same folder.
  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

  /// Returns in words what to open, once a snapshot was written and if the results are then in this
  /// folder. The text is empty if the scene requests no fields.
  std::string file_to_open(const std::string &folder) const;

private:
  void write(const Solution &solution, const std::vector<Grid> &grids);
  /// Returns the name of the index file.
  std::string index() const;
  /// Returns the groups of blocks.
  std::vector<std::string> groups() const;
  /// Writes a file for each block. Collective.
  void write_blocks(const std::vector<Grid> &grids, double time);
  void write_index() const;

  const Scene &scene_;
  MPI_Comm communicator_;
  std::string folder_;
  bool is_first_rank_;
  bool is_preview_ = false;
  unsigned int n_written_ = 0;
  struct Snapshot {
    double time;
    std::string file; ///< name in the folder
  };
  std::vector<Snapshot> snapshots_;
  std::vector<std::string> xdmf_grids_; ///< descriptions of the snapshots; several may be one text
};

} // namespace billet

#endif
