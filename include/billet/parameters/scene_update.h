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

/// Scene file with the current names.
struct SceneUpdate {
  std::string text;
  /// "scene.prm:12: 'Old name' is now 'New name'", for each change in the file.
  std::vector<std::string> changes;
  /// Old names in included files, which are not changed.
  std::vector<std::string> left;
};

/// Replaces old names in a scene file, or in a file that a scene includes. Everything else stays,
/// except that blanks before an equals sign may change to keep its column. Throws InputError.
SceneUpdate update_scene(const std::string &file_name);

} // namespace billet

#endif
