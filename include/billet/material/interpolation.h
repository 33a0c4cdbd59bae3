// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_INTERPOLATION_H
#define BILLET_MATERIAL_INTERPOLATION_H

#include <array>
#include <vector>

namespace billet {

/// Points (x, y) of a curve, at least one; x increases strictly.
using CurvePoints = std::vector<std::array<double, 2>>;

/// Returns the curve at x: linear between its points, and constant beyond both ends.
double interpolate(const CurvePoints &points, double x);
/// Returns its slope, at a point that of the segment behind it.
double find_slope(const CurvePoints &points, double x);

} // namespace billet

#endif
