// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_LIBRARIES_H
#define BILLET_PARAMETERS_LIBRARIES_H

#include "billet/parameters/scene_file.h"

namespace billet::parameters {

/// Parameter of a scene that names shared libraries.
extern const char libraries_key[];

/// Loads the shared libraries that the scene names, each once in a process, and lets them register
/// their types (plugin.h). Throws InputError for a library that cannot be loaded, was built with
/// another version of the program, or fails to register.
void load_libraries(const SceneFile &file);

} // namespace billet::parameters

#endif
