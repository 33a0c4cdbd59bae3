// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/contact_losses.h"

#include "billet/diagnostic_kinds.h"
#include "billet/state.h"

#include <algorithm>
#include <numeric>
#include <sstream>

namespace billet {

namespace {

/// When losses are reported, and which.
struct ContactLossesLimits {
  /// Part of the largest energy above which losses are reported: they then show in the motion.
  static constexpr double much = 0.05;
  /// Growth since the last message after which they are reported again, so that messages stay few.
  static constexpr double again = 2.;
  /// Part of the total below which a cause is not named beside the largest.
  static constexpr double small = 0.05;
};

/// Name of a cause in messages, and advice to the user.
struct Description {
  const char *name, *advice;
};
Description describe(const ContactLosses::Cause cause) {
  switch (cause) {
  case ContactLosses::impacts:
    return {"damped impacts within a step",
            "If bodies should rebound, reduce 'Error tolerance', 'Maximum step' or 'Normal penalty'"};
  case ContactLosses::friction:
    return {"tangential penalties in damped steps", "Reduce 'Maximum step' or 'Tangential penalty'"};
  case ContactLosses::crossings:
    return {"nodes that open or close within a step, and changing contact areas",
            "Reduce 'Maximum step' or 'Normal penalty'"};
  case ContactLosses::n_causes:
    break;
  }
  return {"", ""};
}

} // namespace

double ContactLosses::total() const { return std::accumulate(energies_.begin(), energies_.end(), 0.); }

double ContactLosses::give_back(const double energy) {
  double left = energy;
  for (const Cause cause : {crossings, impacts}) {
    const double part = std::min(left, energies_[cause]);
    energies_[cause] -= part;
    left -= part;
  }
  return energy - left;
}

DiagnosticList ContactLosses::watch(const double max_energy, const double time) {
  if (!(max_energy > 0.))
    return {};
  const double part = total() / max_energy;
  if (part <= std::max(ContactLossesLimits::much, ContactLossesLimits::again * reported_))
    return {};
  reported_ = part;
  std::array<Cause, n_causes> order{};
  for (std::size_t i = 0; i < order.size(); ++i)
    order[i] = static_cast<Cause>(i);
  std::sort(order.begin(), order.end(),
            [this](const Cause a, const Cause b) { return energies_[a] > energies_[b]; });
  std::ostringstream what;
  what.precision(2);
  what << "Contact removes " << 100. * part << " % of the maximum energy so far";
  for (const Cause cause : order)
    if (cause == order[0] || energies_[cause] > ContactLossesLimits::small * total())
      what << (cause == order[0] ? ": " : "; ") << 100. * energies_[cause] / max_energy << " % by "
           << describe(cause).name;
  return {Diagnostic(diagnostic::contact_dissipates, what.str())
              .time(time)
              .measure("part of the largest energy", part)
              .value("by impacts", energies_[impacts] / max_energy)
              .value("by friction springs", energies_[friction] / max_energy)
              .value("by crossings", energies_[crossings] / max_energy)
              .advice(describe(order[0]).advice)};
}

std::vector<double> ContactLosses::save() const {
  return {energies_[impacts], energies_[friction], energies_[crossings], reported_};
}

void ContactLosses::load(const std::vector<double> &numbers) {
  RowReader row(numbers);
  for (double &energy : energies_)
    energy = row.number();
  reported_ = row.number();
}

} // namespace billet
