// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_STEP_ENTITIES_H
#define BILLET_GEOMETRY_STEP_ENTITIES_H

#include <string>

namespace billet {

/// Checks the entities of a STEP file by the grammar of ISO 10303-21. It checks their numbers, how
/// many parameters and coordinates those of shapes have, and that radii are > 0. Each must refer to
/// entities of the right kind (ISO 10303-42). Returns the first fault, an empty text if there is
/// none.
std::string find_faulty_entity(const std::string &text);

} // namespace billet

#endif
