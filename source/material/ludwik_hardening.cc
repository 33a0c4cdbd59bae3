// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/hardening.h"

namespace billet {

HardeningType ludwik_hardening_type();

HardeningType ludwik_hardening_type() {
  using Kind = TypeParameter::Kind;
  return {"Ludwik",
          "Sy + B e^n, that of Johnson and Cook",
          {yield_stress_parameter,
           {"Hardening coefficient", "0", Kind::number, "B >= 0. Stress that is added at e = 1. [stress]"},
           {"Hardening exponent", "0", Kind::number, "0 <= n <= 1. Hardening exponent."}},
          [](const TypeInput &input) {
            const double yield_stress = input.positive("Yield stress"),
                         coefficient = read_hardening(input, "Hardening coefficient"),
                         exponent = read_hardening(input, "Hardening exponent");
            if (exponent > 1.)
              input.reject("Hardening exponent", "a number from 0 to 1");
            return make_hardening(LudwikHardening{yield_stress, coefficient, exponent});
          }};
}

} // namespace billet
