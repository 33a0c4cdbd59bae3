// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_INTEGRATION_TIME_INTEGRATOR_TYPE_H
#define BILLET_INTEGRATION_TIME_INTEGRATOR_TYPE_H

#include "billet/integration/time_integrator.h"
#include "billet/registered_type.h"

namespace billet {

/// Time integrator that a scene file can name.
using TimeIntegratorType = RegisteredType<TimeIntegrator>;

TypeTable<TimeIntegrator> &time_integrator_types();

/// Returns the method of Newmark (1959). β > 0; second order for γ = ½, unconditionally stable for
/// 2β ≥ γ ≥ ½.
TimeIntegrator newmark(double beta, double gamma);

/// Returns the method of Hilber, Hughes & Taylor (1977): −⅓ ≤ α ≤ 0, β = (1 − α)²/4, γ = ½ − α;
/// α_f = −α here.
TimeIntegrator hilber_hughes_taylor(double alpha);

/// Returns the generalised-α method of Chung & Hulbert (1993): 0 ≤ ρ ≤ 1, the spectral radius at
/// infinite frequency.
TimeIntegrator generalised_alpha(double spectral_radius);

} // namespace billet

#endif
