// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_ELEMENT_MEANS_H
#define BILLET_OUTPUT_ELEMENT_MEANS_H

#include "billet/diagnostics.h"
#include "billet/solve/solution.h"

#include <string>
#include <vector>

namespace billet {

/// Values of the owned elements, by body, in the order of Discretization::elements().
using ElementValues = std::vector<std::vector<double>>;

/// Returns smoothed values: each element has the mean of its nodes' means. A node's mean is over
/// the elements of the body around it, weighted by undeformed volume. Collective.
ElementValues smooth(const Discretization &discretization, const ElementValues &values);

/// Pressure checkerboard: the part of the pressures that alternates from element to element, as
/// bricks with one pressure each allow (Sussman & Bathe, Comput. Struct. 26 (1987) 357-409). The
/// indicator is d = p - S p, with S as in smooth(). For a checkerboard, d contains all of it and S
/// d vanishes; for a smooth field, S d retains nearly all of d.
struct Checkerboard {
  double size = 0.;        ///< sqrt(sum V d^2 / sum V p^2), 0 without pressure
  double alternating = 0.; ///< sqrt(sum V (d - S d)^2 / sum V d^2): 1 for a checkerboard

  /// Returns a message if it is large.
  DiagnosticList check() const;
};

/// Measures the checkerboard. Returns zeros for meshes with too few elements to distinguish it from
/// gradients of stress. Collective.
Checkerboard find_checkerboard(const Solution &solution, const Discretization &discretization);

} // namespace billet

#endif
