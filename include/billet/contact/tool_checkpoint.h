// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_CHECKPOINT_H
#define BILLET_CONTACT_TOOL_CHECKPOINT_H

#include "billet/contact/tool_penalties.h"

namespace billet {

/// Saves the state of contact with a tool at the start of the step.
void save_tool_contact(const RigidContactParts &parts, const ToolPenalties &penalties, StateWriter &writer,
                       const NodeKeys &keys);
/// Loads it into parts without a step yet.
void load_tool_contact(const StateReader &reader, const NodeKeys &keys, RigidContactParts &parts,
                       ToolPenalties &penalties);

} // namespace billet

#endif
