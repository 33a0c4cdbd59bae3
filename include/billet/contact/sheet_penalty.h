// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SHEET_PENALTY_H
#define BILLET_CONTACT_SHEET_PENALTY_H

#include "billet/discretization/boundary_facets.h"

namespace billet {

/// Penalty for sheets on tools in statics once nodes chatter [E/h], (T13) of
/// doc/theory/contact_tools.md.
constexpr double sheet_penalty = 10. / 256.;

/// Whether a pair with these facets may get it: its penalty is the default, and its body is thin
/// beside their extent. Collective.
bool may_have_sheet_penalty(const ContactPair &pair, const Discretization &discretization,
                            const std::vector<BoundaryFacet> &facets);

} // namespace billet

#endif
