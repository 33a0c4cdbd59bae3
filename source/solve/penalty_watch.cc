// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/penalty_watch.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

std::string PenaltyWatch::look(const std::string &pair, const Penetration &deepest,
                               const double displacement) {
  constexpr double deep = 0.1;       // of a facet: what is deeper is seen in pictures and counts in areas
  constexpr double much_taken = 0.1; // of the motion
  constexpr double much_deeper = 10.;
  // Depth that may matter for the second sign [facet sizes].
  const double least = motion_ == Motion::slow ? 1e-6 : 2e-2;
  Record &record = pairs_[pair];
  record.displacement = std::max(record.displacement, displacement);
  const bool takes_motion = deepest.of_facet > least && deepest.length > much_taken * record.displacement;
  if (!(deepest.of_facet > deep || takes_motion) ||
      (record.told > 0. && deepest.of_facet < much_deeper * record.told))
    return "";
  record.told = deepest.of_facet;
  has_told_ = true;
  std::ostringstream text;
  text.precision(3);
  text << "Contact pair '" << pair << "' lets nodes " << deepest.of_facet << " facet sizes deep";
  if (takes_motion)
    text << ", " << std::round(100. * std::min(1., deepest.length / record.displacement))
         << " % of the largest displacement so far";
  text << ": its penalty is soft for what presses here. Try a larger 'Normal penalty'"
       << (motion_ == Motion::slow ? " or a 'Penetration tolerance'" : "");
  return text.str();
}

double largest_motion(const Placement &from, const Placement &to, const double radius) {
  return (to.moved_centre() - from.moved_centre()).norm() + (to.rotation - from.rotation).norm() * radius;
}

} // namespace billet
