// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_ALL_ERRORS_H
#define BILLET_RUN_ALL_ERRORS_H

#include "billet/diagnostics.h"
#include "billet/parameters/scene_file.h"

#include <mpi.h>

#include <string>
#include <vector>

namespace billet {

/// Scene file with what the command line changes.
struct SceneSource {
  std::string file_name;
  std::string restart_file; ///< empty: that of the scene
  std::vector<SceneFile::Setting> settings;
};

/// Returns all errors of a scene file that was refused with `first`. Each stage of the checks shows
/// errors only if those before pass. So the function takes the parts with errors out of the scene,
/// and checks what is left in the same way, until that passes.
///
/// Parts are a mesh, a material, a support, a load, a tool, a pair, a probe, an amplitude, and each
/// parameter of another section. What depends on a part that is missing counts as unchecked, and
/// the last message, a note, names it. Collective.
DiagnosticList find_all_errors(const SceneSource &source, const DiagnosticList &first, MPI_Comm communicator);

} // namespace billet

#endif
