// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_BODY_VOLUMES_H
#define BILLET_DISCRETIZATION_BODY_VOLUMES_H

#include "billet/discretization/discretization.h"

#include <vector>

namespace billet {

/// Returns the undeformed volumes of the bodies [length^3], the same on all ranks. Collective.
std::vector<double> measure_body_volumes(const Discretization &discretization);

} // namespace billet

#endif
