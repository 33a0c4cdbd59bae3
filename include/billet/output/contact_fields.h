// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_CONTACT_FIELDS_H
#define BILLET_OUTPUT_CONTACT_FIELDS_H

#include "billet/solve/solution.h"

#include <array>

namespace billet {

/// Returns nodal contact fields, three in each ghosted vector of displacement dofs: pressure, gap
/// and slip; status, area and pair; traction. Nodes without a contact pair have gap 0 and status
/// −1. Collective.
std::array<Vector, 3> collect_contact_fields(const Discretization &discretization, const Solution &solution);

} // namespace billet

#endif
