// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/penalty_watch.h"

#include "billet/diagnostic_kinds.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

std::optional<Diagnostic> PenaltyWatch::look(const std::string &pair, const Penetration &deepest,
                                             const double displacement, const double part_of_work) {
  constexpr double deep = 0.1;       // of a facet: what is deeper is seen in pictures and counts in areas
  constexpr double much_taken = 0.2; // of the motion: a fifth of what bodies would bear
  constexpr double much_deeper = 10.;
  const bool is_slow = motion_ == Motion::slow;
  // Depth that may matter for the second sign [facet sizes].
  const double least = is_slow ? 1e-6 : 2e-2;
  Record &record = pairs_[pair];
  record.displacement = std::max(record.displacement, displacement);
  const bool is_deep = deepest.of_facet > deep;
  const bool takes_motion = deepest.of_facet > least && deepest.length > much_taken * record.displacement;
  const bool takes_work = is_slow && deepest.of_facet > least && part_of_work > much_taken;
  has_soft_pairs_ = has_soft_pairs_ || is_deep || takes_motion || takes_work;
  if (!(is_deep || takes_work || (is_slow && takes_motion)) ||
      (record.told > 0. && deepest.of_facet < much_deeper * record.told))
    return std::nullopt;
  record.told = deepest.of_facet;
  std::ostringstream text;
  text.precision(3);
  text << "Nodes penetrate by " << deepest.of_facet << " facet sizes";
  if (takes_motion)
    text << ", " << std::round(100. * std::min(1., deepest.length / record.displacement))
         << " % of the largest displacement so far";
  else if (takes_work)
    text << "; the contact holds " << std::round(100. * part_of_work) << " % of the work done so far";
  return Diagnostic(diagnostic::penalty_too_low, text.str())
      .pair(pair)
      .measure("penetration [facet sizes]", deepest.of_facet)
      .advice(is_slow ? "Increase 'Normal penalty', or set a 'Penetration tolerance'"
                      : "Increase 'Normal penalty'");
}

double largest_motion(const Placement &from, const Placement &to, const double radius) {
  return (to.moved_centre() - from.moved_centre()).norm() + (to.rotation - from.rotation).norm() * radius;
}

} // namespace billet
