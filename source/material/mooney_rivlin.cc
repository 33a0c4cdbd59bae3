// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/isochoric_energy.h"

namespace billet {

ElasticityType mooney_rivlin_type();

/// W = C10 (I1 − 3) + C01 (I2 − 3) (Mooney 1940, Rivlin 1948): Ogden's with exponents 2 and −2.
ElasticityType mooney_rivlin_type() {
  using Kind = TypeParameter::Kind;
  return hyperelastic_type(
      "Mooney-Rivlin", "W = C10 (I1 - 3) + C01 (I2 - 3), rubber at moderate strains",
      {{"C10", "0", Kind::number, "Coefficient of I1 - 3. [stress]"},
       {"C01", "0", Kind::number, "Coefficient of I2 - 3. [stress]"}},
      "C10", [](const TypeInput &input) {
        return make_ogden_energy({2. * input.number("C10"), -2. * input.number("C01")}, {2., -2.});
      });
}

} // namespace billet
