// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/integration/time_integrator_type.h"

namespace billet {

TimeIntegrator newmark(const double beta, const double gamma) { return {0., 0., beta, gamma}; }

TimeIntegratorType newmark_type() {
  using Kind = TypeParameter::Kind;
  return {
      "Newmark",
      "Newmark (1959), without numerical dissipation for gamma = 0.5",
      {{"Beta", "0.25", Kind::number, "At least half of gamma, so that no step is too long to be stable."},
       {"Gamma", "0.5", Kind::number,
        "At least 0.5; more damps high frequencies, at the price of first order."}},
      [](const TypeInput &input) {
        const double gamma = input.number("Gamma"), beta = input.number("Beta");
        if (gamma < 0.5)
          input.reject("Gamma", "a number >= 0.5: less feeds vibrations with energy");
        if (2. * beta < gamma)
          input.reject("Beta", "a number not below half of 'Gamma': less is unstable in long steps");
        return newmark(beta, gamma);
      }};
}

} // namespace billet
