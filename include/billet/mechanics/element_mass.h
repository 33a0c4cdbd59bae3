// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_ELEMENT_MASS_H
#define BILLET_MECHANICS_ELEMENT_MASS_H

#include "billet/mechanics/mean_dilatation.h"

namespace billet {

/// Row-major 8 × 8 mass matrix, the same for each of the three directions [mass].
using ElementMass = std::array<double, std::size_t{n_element_nodes} * n_element_nodes>;

/// Returns ∫ N_a dV of each node [length³]; the quadrature is exact.
std::array<double, n_element_nodes> compute_nodal_volumes(const ReferenceElement &element);

/// Returns the consistent mass matrix ρ ∫ N_a N_b dV of the undeformed element, by 2 × 2 × 2
/// points. It is exact for parallelepipeds; its row sums ρ ∫ N_a dV are exact for every trilinear
/// hexahedron.
ElementMass compute_element_mass(const ReferenceElement &element, double density);

/// Lumps the mass matrix: replaces it with the row sums on the diagonal, as in explicit dynamics.
void lump(ElementMass &mass);

} // namespace billet

#endif
