// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_SCENE_FILES_H
#define BILLET_PARAMETERS_SCENE_FILES_H

#include "billet/parameters/scene.h"

#include <string>
#include <vector>

namespace billet::parameters {

/// Returns the files that a scene is made of, as paths from the working directory. They are its
/// own, those that it includes, and those that its entries name, such as meshes and tables. The
/// checkpoint that it resumes from is none of them. Reads the scene file again; returns its name
/// alone if that fails.
std::vector<std::string> find_files(const Scene &scene);

} // namespace billet::parameters

#endif
