// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_OUTPUT_FOLDER_H
#define BILLET_RUN_OUTPUT_FOLDER_H

#include "billet/parameters/scene.h"

namespace billet {

/// Throws InputError if the scene's output folder is not there and cannot be made, or cannot be written to.
void check_output_folder(const parameters::Scene &parameters);

/// Makes the folder and puts a copy of the scene as it was read into it. First rank only. Throws InputError
/// if that fails.
void prepare_output_folder(const parameters::Scene &parameters);

} // namespace billet

#endif
