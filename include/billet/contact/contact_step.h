// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CONTACT_STEP_H
#define BILLET_CONTACT_CONTACT_STEP_H

#include "billet/algebra/vector.h"
#include "billet/geometry/placement.h"

#include <vector>

namespace billet {

/// The step in which a contact pair computes forces.
struct ContactStep {
  double start, end; ///< [time]
  double duration;   ///< end − start, with the bits of the scheme [time]
  const std::vector<Placement> &tools_at_start, &tools_at_end; ///< of all tools of the scene
};

/// A motion of bodies and tools along straight paths.
struct ContactPath {
  const Vector &from, &to; ///< displacements (ghosted)
  const std::vector<Placement> &tools_from, &tools_to;
  bool is_thorough; ///< also checks motions that are small compared with facets
};

} // namespace billet

#endif
