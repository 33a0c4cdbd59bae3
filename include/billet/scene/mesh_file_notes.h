// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_MESH_FILE_NOTES_H
#define BILLET_SCENE_MESH_FILE_NOTES_H

#include "billet/diagnostics.h"
#include "billet/parameters/reader.h"
#include "billet/scene/mesh_builder.h"

#include <map>
#include <string>
#include <vector>

namespace billet {

/// Collects what the user should know about the mesh files of a scene, body by body.
class MeshFileNotes {
public:
  /// Adds the file of a body.
  void add(const LoadedMesh &loaded, const parameters::Mesh &mesh, const std::string &body);
  /// Returns the notes on all bodies, and on volumes that no body takes.
  DiagnosticList all() const;

private:
  struct File {
    Located<std::string> name; ///< of the first body with this file
    std::vector<VolumeChoice> choices;
  };
  DiagnosticList notes_;
  std::map<std::string, File> files_; ///< by their names
};

} // namespace billet

#endif
