// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_FIELD_WRITER_H
#define BILLET_OUTPUT_FIELD_WRITER_H

#include "billet/solve/solution.h"
#include "billet/state.h"

#include <deal.II/base/data_out_base.h>

#include <string>
#include <vector>

namespace billet {

/// Field output for ParaView: the deformed bodies with the requested fields, as VTU or HDF5, and the tools as
/// VTP. An index file lists all snapshots. It is rewritten with each snapshot, so that results of an
/// interrupted run remain readable.
class FieldWriter {
public:
  FieldWriter(const Scene &scene, MPI_Comm communicator, std::string folder);

  /// Writes a snapshot. Collective.
  void write(const Solution &solution);

  /// Saves and restores the list of snapshots, so that a resumed run continues the files in the same folder.
  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

  /// Returns the file to open, once a snapshot was written; empty if the scene requests no fields.
  std::string file_to_open() const;

private:
  void write_tools(const Solution &solution, const std::string &name) const;
  void write_index() const;

  const Scene &scene_;
  MPI_Comm communicator_;
  std::string folder_;
  bool is_first_rank_;
  unsigned int n_written_ = 0;
  struct Snapshot {
    double time;
    std::string fields, tools; ///< file names in the folder
  };
  std::vector<Snapshot> snapshots_;
  std::vector<dealii::XDMFEntry> xdmf_entries_;
};

} // namespace billet

#endif
