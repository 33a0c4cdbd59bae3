// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_PARAVIEW_SCRIPT_H
#define BILLET_OUTPUT_PARAVIEW_SCRIPT_H

#include "billet/scene/scene.h"

#include <string>

namespace billet {

/// Name of the script in the output folder.
const std::string paraview_script_name = "show_in_paraview.py";

/// Returns a Python script that opens the results beside it in ParaView. `index`: the file that
/// lists them. It looks at a section from its front. A preview is shown with its supports, loads
/// and tools at the end, and bodies in the colours of their boundary ids, with names.
std::string paraview_script(const std::string &index, const Scene &scene, bool is_preview);

} // namespace billet

#endif
