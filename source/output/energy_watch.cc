// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/energy_watch.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

std::string EnergyWatch::advise(const Cause cause) {
  switch (cause) {
  case Cause::soft_penalties:
    return "contact pairs are soft, and penalties on areas that grow while nodes are deep make energy. Try a "
           "larger 'Normal penalty'";
  case Cause::sticking_overlaps:
    return "what bodies with friction overlap by changes while they stick. Try 'Facets = bilinear' for their "
           "contact pairs";
  case Cause::unstable_law:
    return "an elastic body is strained farther than its law is stable, and waves grow in it. Try smaller "
           "strains, or the 'Kinematics' that the log names, if it does";
  case Cause::inexact_dissipation:
    return "a body that yields has large elastic strains, and its law, which is not Hencky's, knows what it "
           "dissipates to their order only. Try 'Kinematics = Hencky', or a larger 'Largest drift'";
  case Cause::steps:
    break;
  }
  return "steps do not resolve how contacts open and close. Try a smaller 'Error tolerance' or 'Largest "
         "step', a softer penalty, or a smaller 'Spectral radius'";
}

std::string EnergyWatch::look(const double time, const EnergyLedger &energies,
                              const std::function<Cause()> &find_cause) {
  // What is there counts half only, as in explicit dynamics: energy from nowhere must not hide itself.
  largest_ =
      std::max({largest_, 0.5 * std::abs(energies.total()), std::abs(energies.initial + energies.external)});
  std::ostringstream text;
  text.precision(3);
  const double drift = std::abs(energies.drift());
  if (balance_ != Balance::is_left && !told_balance_ && drift > allowed_drift_ * largest_) {
    told_balance_ = true;
    std::ostringstream what;
    what.precision(3);
    what << "the energies fail to balance by " << 100. * drift / largest_ << " % of the largest so far";
    if (balance_ == Balance::is_kept) {
      what << ", allowed are " << 100. * allowed_drift_ << " % ('Largest drift'): " << advise(find_cause());
      imbalance_ = what.str();
    } else
      text << "At time " << time << " " << what.str() << ": " << advise(find_cause());
  }
  return text.str();
}

} // namespace billet
