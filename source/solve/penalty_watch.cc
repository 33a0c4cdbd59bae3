// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/penalty_watch.h"

#include "billet/diagnostic_kinds.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

namespace {

/// Signs of penalties that are too low.
struct PenaltyWatchLimits {
  /// Penetration that is too deep [facet sizes]: deeper nodes are visible in field output and
  /// affect areas.
  static constexpr double deep = 0.1;
  /// Penetration over the largest displacement, or energy of springs over all work. From this part
  /// on, springs change the result visibly.
  static constexpr double much_taken = 0.2;
  /// Penetration below which these parts are irrelevant, in slow and in sudden motion [facet
  /// sizes].
  static constexpr double min_in_slow_motion = 1e-6, min_in_sudden_motion = 2e-2;
  /// Part of all work in springs below which a short penetration in an impact is irrelevant.
  static constexpr double counts = 0.01;
};

} // namespace

DiagnosticList PenaltyWatch::check(const std::string &pair, const double time, const Penetration &deepest,
                                   const double displacement, const double part_of_work) {
  const bool is_slow = motion_ == Motion::slow;
  const double minimum =
      is_slow ? PenaltyWatchLimits::min_in_slow_motion : PenaltyWatchLimits::min_in_sudden_motion;
  double &maximum = displacements_[pair];
  maximum = std::max(maximum, displacement);
  const bool is_deep = deepest.of_facet > PenaltyWatchLimits::deep;
  const bool takes_motion =
      deepest.of_facet > minimum && deepest.length > PenaltyWatchLimits::much_taken * maximum;
  const bool takes_work =
      is_slow && deepest.of_facet > minimum && part_of_work > PenaltyWatchLimits::much_taken;
  const bool was_deep = are_deep_[pair];
  are_deep_[pair] = is_deep;
  const bool matters = is_slow || was_deep || part_of_work > PenaltyWatchLimits::counts;
  has_low_penalties_ = has_low_penalties_ || is_deep || takes_motion || takes_work;
  if (!((is_deep && matters) || takes_work || (is_slow && takes_motion)))
    return {};
  std::ostringstream text;
  text.precision(3);
  text << "Nodes penetrate by " << deepest.of_facet << " facet sizes";
  if (takes_motion)
    text << ", " << std::round(100. * std::min(1., deepest.length / maximum))
         << " % of the maximum displacement so far";
  else if (takes_work)
    text << "; the penalty stores " << std::round(100. * part_of_work) << " % of the work done so far";
  return {Diagnostic(diagnostic::penalty_too_low, text.str())
              .pair(pair)
              .time(time)
              .measure("penetration [facet sizes]", deepest.of_facet)
              .advice(std::string("Increase 'Normal penalty'") +
                      (is_slow ? ", or set a 'Penetration tolerance'" : ""))};
}

void PenaltyWatch::save(StateWriter &writer) const {
  std::string pairs; // a line each
  std::vector<double> values{has_low_penalties_ ? 1. : 0.};
  for (const auto &[pair, maximum] : displacements_) {
    pairs += pair + "\n";
    values.push_back(maximum);
    values.push_back(are_deep_.at(pair) ? 1. : 0.);
  }
  writer.write_text("watched pairs", pairs);
  writer.write("watched depths", values);
}

void PenaltyWatch::load(const StateReader &reader) {
  std::istringstream pairs(reader.read_text("watched pairs"));
  const std::vector<double> values = reader.read("watched depths");
  RowReader row(values);
  has_low_penalties_ = row.flag();
  for (std::string pair; std::getline(pairs, pair);) {
    displacements_[pair] = row.number();
    are_deep_[pair] = row.flag();
  }
}

double max_motion(const Placement &from, const Placement &to, const double radius) {
  return (to.moved_centre() - from.moved_centre()).norm() + (to.rotation - from.rotation).norm() * radius;
}

} // namespace billet
