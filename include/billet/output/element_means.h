// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_ELEMENT_MEANS_H
#define BILLET_OUTPUT_ELEMENT_MEANS_H

#include "billet/diagnostics.h"
#include "billet/solve/solution.h"

#include <string>
#include <vector>

namespace billet {

/// A value of each owned element, by body, in the order of Discretization::elements().
using ElementValues = std::vector<std::vector<double>>;

/// Of each element the mean of its nodes' means, each over the elements of the body around the node, weighted
/// with their undeformed volumes. Collective.
ElementValues smooth(const Discretization &discretization, const ElementValues &values);

/// How far stresses jump between elements, an indication of what the mesh makes, after Zienkiewicz & Zhu
/// (1987): √(Σ V |σ − σ*|² / Σ V |σ|²) over all elements, σ the mean Cauchy stress of one of volume V, σ*
/// that of smooth(). It falls with the element's size, and is an error of stresses: forces are better. 0
/// without stress. Collective.
double stress_jumps(const Solution &solution, const Discretization &discretization);

/// What of the pressures alternates from element to element, as bricks with one pressure each may (Sussman &
/// Bathe, Comput. Struct. 26 (1987) 357-409): d = p - S p, S as smooth(), of which a checkerboard keeps all
/// and S d nothing, while of a smooth field S d keeps nearly all.
struct Checkerboard {
  double size = 0.;        ///< sqrt(sum V d^2 / sum V p^2), 0 without pressure
  double alternating = 0.; ///< sqrt(sum V (d - S d)^2 / sum V d^2): 1 of a checkerboard

  /// A message if it is large.
  DiagnosticList check() const;
};

/// Of meshes with so few elements that a checkerboard cannot be told from their stresses: zeros. Collective.
Checkerboard find_checkerboard(const Solution &solution, const Discretization &discretization);

} // namespace billet

#endif
