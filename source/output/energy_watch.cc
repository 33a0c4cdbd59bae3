// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/energy_watch.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

std::string EnergyWatch::look(const double time, const EnergyLedger &energies) {
  constexpr double doubtful_drift = 0.05, doubtful_hourglass = 0.1;
  constexpr double counts = 0.01; // less than that of the largest energy is no matter
  // What is there counts half only, as in explicit dynamics: energy from nowhere must not hide itself.
  largest_ =
      std::max({largest_, 0.5 * std::abs(energies.total()), std::abs(energies.initial + energies.external)});
  std::ostringstream text;
  text.precision(3);
  const double drift = std::abs(energies.drift());
  if (balance_ == Balance::is_told && !told_balance_ && drift > doubtful_drift * largest_) {
    told_balance_ = true;
    text << "At time " << time << " the energies fail to balance by " << 100. * drift / largest_
         << " % of the largest so far: steps do not resolve how contacts open and close. Try a smaller "
            "'Error tolerance' or 'Largest step', a softer penalty, or a smaller 'Spectral radius'";
  }
  const double taken_up = energies.elastic + energies.plastic + energies.hourglass;
  if (!told_hourglass_ && energies.hourglass > doubtful_hourglass * taken_up &&
      energies.hourglass > counts * largest_) {
    told_hourglass_ = true;
    text << (text.str().empty() ? "" : "\n") << "At time " << time << " hourglass control has "
         << 100. * energies.hourglass / taken_up
         << " % of the energy that deforms the bodies: one-point elements are coarse for this. Try a finer "
            "mesh, "
            "another 'Hourglass stiffness', or 'Element = mean dilatation'";
  }
  return text.str();
}

} // namespace billet
