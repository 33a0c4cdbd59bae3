// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_FIELD_WRITER_H
#define BILLET_OUTPUT_FIELD_WRITER_H

#include "billet/solve/solution.h"
#include "billet/state.h"

#include <deal.II/base/data_out_base.h>

#include <string>
#include <vector>

namespace billet {

/// Pictures of the state for ParaView: the deformed bodies with the fields that the scene asks for, as VTU or
/// HDF5, and the tools where they are, as VTP. An index file ties them together over time and is rewritten
/// each time, so that a run that stops leaves all that it had computed.
class FieldWriter {
public:
  FieldWriter(const Scene &scene, MPI_Comm communicator, std::string folder);

  /// Collective.
  void write(const Solution &solution);

  /// Goes on with the pictures of a run whose files are in the same folder.
  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

  /// The file to open, once something was written; empty if the scene wants no fields.
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
