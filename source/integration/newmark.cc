// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/integration/time_integrator_type.h"

namespace billet {

TimeIntegrator newmark(const double beta, const double gamma) { return {0., 0., beta, gamma}; }

TimeIntegratorType newmark_type() {
  using Kind = TypeParameter::Kind;
  return {"Newmark",
          "Newmark (1959), without numerical dissipation of linear vibrations for gamma = 0.5. Contact that "
          "opens or closes within a step dissipates all the same",
          {{"Beta", "0.25", Kind::number, ">= gamma / 2, for unconditional stability."},
           {"Gamma", "0.5", Kind::number,
            ">= 0.5. Values above 0.5 damp high frequencies, with first-order accuracy."}},
          [](const TypeInput &input) {
            const double gamma = input.number("Gamma"), beta = input.number("Beta");
            if (gamma < 0.5)
              input.reject("Gamma", "a number >= 0.5: below it vibrations grow");
            if (2. * beta < gamma)
              input.reject("Beta", "a number not below half of 'Gamma': below it long steps are unstable");
            return newmark(beta, gamma);
          }};
}

} // namespace billet
