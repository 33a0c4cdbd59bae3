// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/interpolation.h"

#include <algorithm>

namespace billet {

namespace {

/// Returns the first point above x.
CurvePoints::const_iterator find_above(const CurvePoints &points, const double x) {
  return std::upper_bound(points.begin(), points.end(), x,
                          [](const double value, const auto &point) { return value < point[0]; });
}

double slope_before(const CurvePoints::const_iterator end) {
  const auto start = end - 1;
  return ((*end)[1] - (*start)[1]) / ((*end)[0] - (*start)[0]);
}

} // namespace

double interpolate(const CurvePoints &points, const double x) {
  const auto above = find_above(points, x);
  if (above == points.begin() || above == points.end())
    return (above == points.begin() ? points.front() : points.back())[1];
  const auto &start = *(above - 1);
  return start[1] + slope_before(above) * (x - start[0]);
}

double find_slope(const CurvePoints &points, const double x) {
  const auto above = find_above(points, x);
  return above == points.begin() || above == points.end() ? 0. : slope_before(above);
}

} // namespace billet
