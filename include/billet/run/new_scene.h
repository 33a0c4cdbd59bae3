// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_NEW_SCENE_H
#define BILLET_RUN_NEW_SCENE_H

#include <string>
#include <vector>

namespace billet {

/// Scene to begin with, for a kind of process: a file of prm/templates.
struct SceneTemplate {
  std::string name, text;
};

/// All templates, in alphabetic order. The build makes them from their files.
const std::vector<SceneTemplate> &scene_templates();

/// Writes the scene of the template `name` into the current folder, NAME.prm, or into `file`.
/// Returns the name of the file. Throws InputError for an unknown name, or if the file exists.
std::string write_new_scene(const std::string &name, const std::string &file = "");

} // namespace billet

#endif
