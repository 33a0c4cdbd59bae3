// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/hardening.h"

namespace billet {

HardeningType voce_hardening_type();

LaneHardening VoceHardening::lane_form() const {
  LaneHardening form;
  form.kind = saturation_stress >= yield_stress ? HardeningKind::voce : HardeningKind::other;
  form.yield_stress = yield_stress;
  form.hardening_modulus = modulus;
  form.saturation_stress = saturation_stress;
  form.saturation_rate = saturation_rate;
  return form;
}

HardeningType voce_hardening_type() {
  using Kind = TypeParameter::Kind;
  return {"Voce",
          "Sy + (Ss - Sy)(1 - exp(-d e)) + H e",
          {yield_stress_parameter,
           hardening_modulus_parameter,
           {"Saturation stress", "0", Kind::number, "Ss >= Sy. Saturation stress. [stress]"},
           {"Saturation rate", "0", Kind::number, "d > 0. Rate of saturation over plastic strain."}},
          [](const TypeInput &input) {
            VoceHardening law{};
            law.yield_stress = input.positive("Yield stress");
            law.modulus = read_hardening(input, "Hardening modulus");
            law.saturation_stress = input.positive("Saturation stress");
            if (law.saturation_stress < law.yield_stress)
              input.reject("Saturation stress", no_softening("a number not below the yield stress"));
            law.saturation_rate = input.positive("Saturation rate");
            return make_hardening(law);
          }};
}

} // namespace billet
