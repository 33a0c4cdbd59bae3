// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_OUTPUT_FOLDER_H
#define BILLET_RUN_OUTPUT_FOLDER_H

#include "billet/parameters/scene.h"

namespace billet {

/// Throws InputError if the scene's output folder does not exist and cannot be made, or is not writable.
void check_output_folder(const parameters::Scene &parameters);

/// Makes the folder and writes a copy of the scene as read into it. First rank only. Throws InputError on
/// failure.
void prepare_output_folder(const parameters::Scene &parameters);

} // namespace billet

#endif
