// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_TOOL_FADE_H
#define BILLET_SOLVE_TOOL_FADE_H

#include "billet/scene/tool.h"

namespace billet {

/// Returns the part of a tool's forces at its removal that is left at t: 1 up to the removal, then
/// linearly less. 0 if the scene never removes the tool, or lets its forces go at once.
double left_after_removal(const Tool &tool, double t);

} // namespace billet

#endif
