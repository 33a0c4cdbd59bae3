// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_ORIENTED_LAW_H
#define BILLET_MATERIAL_ORIENTED_LAW_H

#include "billet/geometry/axes.h"
#include "billet/material/elasticity.h"

namespace billet {

/// Returns a law whose material axes differ from point to point. `law` has them along x, y, z. The
/// new law gives it F Q at a point, with the axes there as columns of Q, (H21) of doc/theory. Q is
/// part of the state, which PointLaw::initialize_at() sets. Moduli and stresses are those of space,
/// and need no change.
///
/// Throws std::invalid_argument for a law in rate form.
SharedLaw orient(const SharedLaw &law, const Axes &axes);

} // namespace billet

#endif
