// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_PATHS_H
#define BILLET_CONTACT_TOOL_PATHS_H

#include "billet/contact/rigid_contact_parts.h"

namespace billet {

/// Returns the part of a motion of body and tool during which no node goes through the tool's
/// surface, as MatrixContact::find_free_part() does.
double find_free_part_of_nodes(const RigidContactParts &parts, const ContactPath &path);

} // namespace billet

#endif
