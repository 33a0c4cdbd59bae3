// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/round_off_watch.h"

#include "billet/diagnostic_kinds.h"
#include "billet/solve/newton.h"

#include <algorithm>
#include <sstream>

namespace billet {

void RoundOffWatch::add(const double time, const double round_off, const double forces) {
  if (round_off > round_off_) {
    round_off_ = round_off;
    time_ = time;
  }
  forces_ = std::max(forces_, forces);
}

DiagnosticList RoundOffWatch::finish(const double tolerance, const bool accepts_all) const {
  if (!(forces_ > 0.) || !(round_off_ > tolerance * forces_))
    return {};
  const double part = round_off_ / forces_;
  std::ostringstream text;
  text.precision(2);
  text << "Round-off in the penalty forces may be " << part << " of the maximum forces; 'Force tolerance' is "
       << tolerance;
  const bool is_notable = part > notable_round_off;
  if (!is_notable)
    text << ". Forces balance to that part only";
  else if (part > 1. && !accepts_all)
    text << ": it exceeds the forces of the scene";
  else if (part > NewtonLimits::max_stalled_residual && !accepts_all)
    text << ": forces are accurate to this part only";
  else
    text << "; residuals up to " << NewtonLimits::max_stalled_residual << " are accepted";
  return {Diagnostic(is_notable ? diagnostic::round_off_limits_forces : diagnostic::balanced_to_round_off,
                     text.str())
              .time(time_)
              .measure("part of the forces", part)};
}

void RoundOffWatch::load(const std::vector<double> &numbers) {
  time_ = numbers.at(0);
  round_off_ = numbers.at(1);
  forces_ = numbers.at(2);
}

} // namespace billet
