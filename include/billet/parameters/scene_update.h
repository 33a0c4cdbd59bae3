// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_SCENE_UPDATE_H
#define BILLET_PARAMETERS_SCENE_UPDATE_H

#include "billet/diagnostics.h"
#include "billet/parameters/scene_file.h"

#include <string>
#include <vector>

namespace billet {

/// Returns a warning for each old name of a parameter, or of a value, that the scene uses.
DiagnosticList describe_old_names(const SceneFile &file);

/// A scene file under today's names.
struct SceneUpdate {
  std::string text;
  /// "scene.prm:12: 'Old name' is now 'New name'", for each change in the file.
  std::vector<std::string> changes;
  /// The same for the files that it includes, which are left as they are.
  std::vector<std::string> left;
};

/// Replaces old names in a scene file, or in a part of one that another file includes. Everything else
/// stays, but for the blanks in front of an equals sign, which stays in its column where it can. Throws
/// InputError.
SceneUpdate update_scene(const std::string &file_name);

} // namespace billet

#endif
