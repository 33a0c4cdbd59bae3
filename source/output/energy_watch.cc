// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/energy_watch.h"

#include "billet/diagnostic_kinds.h"
#include "billet/material/elasticity.h"
#include "billet/material/hardening.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

namespace {

/// Returns the first elasticity whose plastic law has its dissipation exactly, as the beginning of
/// an advice; empty if there is none.
std::string choose_exact_elasticity() {
  const SharedFlow flow = make_hardening(LinearHardening{1., 0.});
  for (const ElasticityType &type : elasticity_types()) {
    const SharedLaw law = type.find_law({1., 1.}, flow);
    if (law != nullptr && law->has_exact_dissipation())
      return "Choose 'Elasticity = " + type.name + "', which has it exactly, or ";
  }
  return "";
}

} // namespace

std::string EnergyWatch::advise(const Cause cause) {
  switch (cause) {
  case Cause::low_penalties:
    return "Penalties are too low: they create energy on areas that change while penetration is large. "
           "Increase 'Normal penalty'";
  case Cause::sticking_overlaps:
    return "The areas of overlapping facets change while friction sticks. Choose 'Facets = bilinear' for "
           "these "
           "contact pairs";
  case Cause::contact_edges:
    return "Contact creates energy, as where an edge of the second body slides along facets of the first. "
           "Swap 'Body' and 'Second body' of that contact pair, or use smaller facets there";
  case Cause::unstable_law:
    return "The law of an elastic body loses its ellipticity. Reduce the strains, or choose the 'Elasticity' "
           "that the warning names";
  case Cause::inexact_dissipation:
    return "A yielding body has large elastic strains, and its law has the dissipation only to first order "
           "in "
           "them. " +
           choose_exact_elasticity() + "increase 'Maximum energy drift'";
  case Cause::softening:
    return "Heat makes the flow stress fall faster than stresses unload, and energy is lost with any step. "
           "Check 'Specific heat' and 'Taylor-Quinney fraction', or give the temperature by 'Temperature' "
           "instead";
  case Cause::steps:
    break;
  }
  return "The steps do not resolve how contacts open and close. Reduce 'Error tolerance', 'Maximum step', "
         "the "
         "penalty or 'Spectral radius'";
}

DiagnosticList EnergyWatch::check(const double time, const EnergyLedger &energies,
                                  const std::function<Cause()> &find_cause) {
  // The current total counts only half, as in explicit dynamics, so that created energy does not
  // hide the imbalance.
  maximum_ =
      std::max({maximum_, 0.5 * std::abs(energies.total()), std::abs(energies.initial + energies.external)});
  DiagnosticList messages;
  const double drift = std::abs(energies.drift());
  if (balance_ != Balance::is_left && drift > allowed_drift_ * maximum_) {
    if (!cause_)
      cause_ = find_cause();
    std::ostringstream what;
    what.precision(3);
    what << "the energies are off balance by " << 100. * drift / maximum_ << " % of the maximum so far";
    if (balance_ == Balance::is_kept) {
      what << "; allowed are " << 100. * allowed_drift_ << " % ('Maximum energy drift')";
      imbalance_ = {what.str(), advise(*cause_)};
    } else {
      std::string text = what.str();
      text.front() = 'T';
      messages.push_back(Diagnostic(diagnostic::energy_imbalance, text)
                             .time(time)
                             .measure("part of the largest energy", drift / maximum_)
                             .advice(advise(*cause_)));
    }
  }
  return messages;
}

} // namespace billet
