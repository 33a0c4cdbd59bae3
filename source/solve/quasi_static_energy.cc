// SPDX-License-Identifier: LGPL-2.1-or-later
// The energy balance of steps.
#include "billet/diagnostic_kinds.h"
#include "billet/solve/quasi_static.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

StepWorks QuasiStatic::compute_step_works() const {
  StepWorks works;
  const double weight = 1. - contact_before();
  for (const auto &contact : contacts_)
    works += contact.compute_step_works(weight);
  for (const auto &contact : body_contacts_)
    works += contact->compute_step_works(weight);
  return works;
}

QuasiStatic::ElementImbalance QuasiStatic::element_imbalance() const {
  Vector increment = trial_, mean = internal_forces_;
  increment -= u_n_;
  mean += internal_forces_n_;
  const double dissipated = std::abs(trial_energies_.plastic - state_.energies.plastic);
  const double missed = trial_energies_.total() - state_.energies.of_elements() - 0.5 * (mean * increment);
  const double by_yielding = std::clamp(missed, -dissipated, dissipated);
  return {by_yielding, missed - by_yielding};
}

bool QuasiStatic::loses_energy(const double t, NewtonReport &report) {
  trial_contact_loss_ = 0.;
  if (motion_ || (contacts_.empty() && body_contacts_.empty()))
    return false;
  Vector increment = trial_, mean = internal_forces_;
  increment -= u_n_;
  mean += internal_forces_n_;
  const double internal_work = 0.5 * (mean * increment);
  mean = contact_forces_;
  mean += contact_forces_n_;
  const double contact_work = 0.5 * (mean * increment);
  trial_contact_loss_ = contact_loss(t).total;
  const StepEnergy::Works works{trial_contact_loss_,
                                std::max(std::abs(internal_work), std::abs(contact_work)), largest_energy_};
  const double floor = round_off_force_ * discretization_.radius();
  const StepEnergy::Verdict verdict = step_energy_.judge(state_.time, t - state_.time, works, floor);
  if (verdict == StepEnergy::Verdict::balanced)
    return false;
  const double percent = 100. * StepEnergy::part_of_all(works);
  std::ostringstream text;
  text.precision(3);
  text << "contact " << (works.imbalance > 0. ? "loses" : "makes") << " energy in the step to time " << t
       << ": " << percent << " % of all work so far";
  if (verdict == StepEnergy::Verdict::jump) {
    trial_contact_loss_ = 0.;
    report.diagnostics.push_back(Diagnostic(diagnostic::energy_imbalance, text.str())
                                     .time(t)
                                     .measure("part of all work [%]", percent)
                                     .advice("Smaller steps do not change this: the bodies jump, as when one "
                                             "slips off another, or have passed through each other. Check "
                                             "the field output at this time; 'Scheme = implicit dynamics' "
                                             "resolves jumps"));
    return false;
  }
  text << ", more than the allowed " << 100. * StepEnergy::max_part
       << " %. The solution jumped to another branch, or bodies passed through each other. Reduce 'Largest "
          "step' or the penalty, or use a finer mesh where they touch";
  report.converged = false;
  report.is_explained = true;
  report.failure = text.str();
  return true;
}

DiagnosticList QuasiStatic::check_balance() const {
  constexpr double doubtful = 0.04; // of all work
  const double floor = round_off_force_ * discretization_.radius();
  if (motion_ || !(std::abs(contact_balance_) > std::max(doubtful * largest_energy_, floor)))
    return {};
  const double percent = 100. * contact_balance_ / largest_energy_;
  std::ostringstream text;
  text.precision(3);
  text << "In the whole run contact " << (percent > 0. ? "has lost " : "has made ") << std::abs(percent)
       << " % of all work";
  return {Diagnostic(diagnostic::energy_imbalance, text.str())
              .time(state_.time)
              .measure("part of all work [%]", percent)
              .advice("Forces of contact do not fit its motion: reduce 'Largest step', or use a finer mesh "
                      "where bodies touch, and check in the field output that they touch where they should")};
}

} // namespace billet
