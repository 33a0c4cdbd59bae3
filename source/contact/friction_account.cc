// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/friction_account.h"

namespace billet {

FrictionAccount compute_friction_account(const FrictionStep &step, const FrictionRule &rule) {
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

} // namespace billet
