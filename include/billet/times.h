// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TIMES_H
#define BILLET_TIMES_H

#include <algorithm>
#include <cmath>

/// Comparisons of times of a run, which are sums of steps, with those that a scene sets. Times are
/// at least 0, in any consistent unit. Times that differ by round-off alone are equal.
namespace billet::times {

/// Relative difference that is round-off. Of a million steps, the sum is off by 1e-10 at most.
constexpr double rounding = 1e-9;

inline bool is_before(const double t, const double other) { return t < other * (1. - rounding); }
inline bool is_after(const double t, const double other) { return t > other * (1. + rounding); }

/// Returns the number of whole intervals up to t. Since 29 · 0.01 exceeds 0.29, or falls short of
/// it, an interval that lacks round-off alone is whole.
inline double count_intervals(const double t, const double interval) {
  return std::floor(t / interval * (1. + rounding));
}

/// Returns the least number of equal steps over a span that are not longer than `longest`; at
/// least 1.
inline double count_steps(const double span, const double longest) {
  return std::max(1., std::ceil(span / longest * (1. - rounding)));
}

} // namespace billet::times

#endif
