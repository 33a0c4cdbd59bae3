// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/friction_account.h"

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

FrictionAccount compute_account_of_equilibria(const FrictionStep &step, const FrictionRule &rule) {
  const bool enters_or_leaves = step.part_in_contact < 1.;
  double work_n = 0., work = 0., stored_n = 0., stored = 0., by_slip_n = 0., by_slip = 0., slip_squared = 0.;
  for (unsigned int i = 0; i < 2; ++i) {
    const double t_n = step.traction_n[i], t = step.traction[i];
    work_n -= 0.5 * t_n * step.motion[i];
    work -= 0.5 * t * step.motion[i];
    const double stretch_n = rule.stores_n ? t_n / rule.stiffness : 0.,
                 stretch = rule.stores ? t / rule.stiffness : 0.;
    stored_n += 0.5 * t_n * stretch_n;
    stored += 0.5 * t * stretch;
    const double slip = step.part_in_contact * step.motion[i] + stretch - stretch_n;
    by_slip_n -= 0.5 * t_n * slip;
    by_slip -= 0.5 * t * slip;
    slip_squared += slip * slip;
  }
  FrictionAccount account;
  if (step.touches) {
    account.dissipation_n = std::max(0., by_slip_n);
    if (step.limit_n > 0.) { // the trapezoidal rule counts t_n·γ even where t_n drives the slip
      account.missed_n = std::max(0., 0.5 * step.limit_n * std::sqrt(slip_squared) - account.dissipation_n);
      account.beyond_n = by_slip_n - account.dissipation_n;
    }
    account.dissipation = std::max(0., by_slip);
  } else
    account.dissipation_n = std::max(0., step.part_in_contact * work_n + stored_n);
  if (enters_or_leaves) {
    account.beyond_n = work_n + stored_n - account.dissipation_n;
    account.beyond = work - stored - account.dissipation;
  }
  return account;
}

FrictionAccount compute_account_of_motion(const FrictionStep &step, const FrictionRule &rule) {
  double work_n = 0., work = 0., stored_n = 0., stored = 0., relaxed = 0.;
  for (unsigned int i = 0; i < 2; ++i) {
    const double t_n = step.traction_n[i], t = step.traction[i];
    work_n -= t_n * step.motion[i];
    work -= t * step.motion[i];
    stored_n += 0.5 * t_n * t_n / rule.stiffness;
    stored += 0.5 * t * t / rule.stiffness;
    relaxed += 0.5 * (t - t_n) * (t - t_n) / rule.stiffness;
  }
  FrictionAccount account;
  if (step.touches && rule.stores_n && rule.stores)
    account.damping = (1. - 2. * rule.start_weight) * relaxed;
  account.dissipation_n = rule.start_weight * work_n + (rule.stores_n ? stored_n : 0.);
  account.dissipation = (1. - rule.start_weight) * work - (rule.stores ? stored : 0.) - account.damping;
  return account;
}

} // namespace

const FrictionAccounting FrictionAccounting::of_motion{&compute_account_of_motion, false};
const FrictionAccounting FrictionAccounting::of_equilibria{&compute_account_of_equilibria, true};

FrictionAccount FrictionAccount::handed_over() const {
  FrictionAccount account = *this;
  account.dissipation_n = std::max(0., dissipation_n + beyond_n);
  account.dissipation = std::max(0., dissipation + beyond);
  account.beyond_n += dissipation_n - account.dissipation_n;
  account.beyond += dissipation - account.dissipation;
  return account;
}

} // namespace billet
