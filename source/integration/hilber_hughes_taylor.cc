// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/integration/time_integrator_type.h"

namespace billet {

TimeIntegrator hilber_hughes_taylor(const double alpha) {
  return {0., -alpha, 0.25 * (1. - alpha) * (1. - alpha), 0.5 - alpha};
}

TimeIntegratorType hilber_hughes_taylor_type() {
  return {"HHT-alpha",
          "Hilber, Hughes & Taylor (1977), of second order, damps high frequencies",
          {{"Alpha", "-0.05", TypeParameter::Kind::number,
            ">= -1/3 and <= 0. -1/3: maximum dissipation. 0: none."}},
          [](const TypeInput &input) {
            constexpr double min_alpha = -1. / 3. - 1e-6; // -0.333333 is meant to be -1/3
            const double alpha = input.number("Alpha");
            if (!(alpha >= min_alpha && alpha <= 0.))
              input.reject("Alpha", "a number from -1/3 to 0");
            return hilber_hughes_taylor(alpha);
          }};
}

} // namespace billet
