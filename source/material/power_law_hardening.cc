// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/hardening.h"

namespace billet {

HardeningType power_law_hardening_type();

LaneHardening PowerLawHardening::lane_form() const {
  LaneHardening form;
  form.kind = exponent >= 0. && exponent <= 1. ? HardeningKind::power_law : HardeningKind::other;
  form.strength = strength;
  form.prestrain = prestrain;
  form.exponent = exponent;
  return form;
}

HardeningType power_law_hardening_type() {
  using Kind = TypeParameter::Kind;
  return {"power law",
          "K (e0 + e)^n",
          {{"Strength coefficient", "0", Kind::number, "K > 0. Strength coefficient. [stress]"},
           {"Prestrain", "0", Kind::number, "e0 > 0. Initial strain."},
           {"Hardening exponent", "0", Kind::number, "0 <= n <= 1. Hardening exponent."}},
          [](const TypeInput &input) {
            PowerLawHardening law{};
            law.strength = input.positive("Strength coefficient");
            law.prestrain = input.positive("Prestrain");
            law.exponent = read_hardening(input, "Hardening exponent");
            if (law.exponent > 1.)
              input.reject("Hardening exponent", "a number from 0 to 1");
            return make_hardening(law);
          }};
}

} // namespace billet
