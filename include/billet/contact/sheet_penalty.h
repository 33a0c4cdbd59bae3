// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SHEET_PENALTY_H
#define BILLET_CONTACT_SHEET_PENALTY_H

#include "billet/discretization/boundary_facets.h"

namespace billet {

/// Default penalty of sheets on tools in statics [E/h], (T13) of doc/theory/contact_tools.md.
constexpr double sheet_penalty = 0.03;

/// Whether a pair with these facets has it: its penalty is the default, and its body is thin beside
/// their extent. Collective.
bool has_sheet_penalty(const ContactPair &pair, const Discretization &discretization,
                       const std::vector<BoundaryFacet> &facets);

} // namespace billet

#endif
