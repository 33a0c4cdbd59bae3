// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/isochoric_energy.h"

namespace billet {

ElasticityType yeoh_type();

/// W = C10 x + C20 x² + C30 x³, x = I1 − 3 (Yeoh 1993).
ElasticityType yeoh_type() {
  using Kind = TypeParameter::Kind;
  return hyperelastic_type(
      "Yeoh", "W = C10 x + C20 x^2 + C30 x^3 with x = I1 - 3, filled rubber",
      {{"C10", "0", Kind::number, "Coefficient of I1 - 3. [stress]"},
       {"C20", "0", Kind::number, "Coefficient of (I1 - 3)^2. [stress]"},
       {"C30", "0", Kind::number, "Coefficient of (I1 - 3)^3. [stress]"}},
      "C10", [](const TypeInput &input) {
        return make_invariant_energy({input.number("C10"), input.number("C20"), input.number("C30")});
      });
}

} // namespace billet
