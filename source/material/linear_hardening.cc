// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/hardening.h"

namespace billet {

HardeningType linear_hardening_type();

LaneHardening LinearHardening::lane_form() const {
  LaneHardening form;
  form.kind = HardeningKind::linear;
  form.yield_stress = yield_stress;
  form.hardening_modulus = modulus;
  return form;
}

HardeningType linear_hardening_type() {
  return {"linear",
          "Sy + H e",
          {yield_stress_parameter, hardening_modulus_parameter},
          [](const TypeInput &input) {
            const double yield_stress = input.positive("Yield stress");
            return make_hardening(LinearHardening{yield_stress, read_hardening(input, "Hardening modulus")});
          }};
}

} // namespace billet
