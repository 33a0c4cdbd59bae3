// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_STRESS_JUMPS_H
#define BILLET_OUTPUT_STRESS_JUMPS_H

#include "billet/solve/solution.h"

namespace billet {

/// How far stresses jump between elements, an indication of what the mesh makes, after Zienkiewicz & Zhu
/// (1987): √(Σ V |σ − σ*|² / Σ V |σ|²) over all elements, σ the mean Cauchy stress of one of volume V, σ* the
/// mean of its nodes' means over the elements of the body around them. It falls with the element's size, and
/// is an error of stresses: forces are better. 0 without stress. Collective.
double stress_jumps(const Solution &solution, const Discretization &discretization);

} // namespace billet

#endif
