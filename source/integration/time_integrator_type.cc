// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/integration/time_integrator_type.h"

namespace billet {

TimeIntegratorType newmark_type();
TimeIntegratorType hilber_hughes_taylor_type();
TimeIntegratorType generalised_alpha_type();

TypeTable<TimeIntegrator> &time_integrator_types() {
  static TypeTable<TimeIntegrator> types{newmark_type(), hilber_hughes_taylor_type(),
                                         generalised_alpha_type()};
  return types;
}

} // namespace billet
