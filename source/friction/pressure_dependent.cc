// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/friction/pressure_dependent.h"

#include <sstream>

namespace billet {

FrictionLawType pressure_dependent_type();

std::string PressureDependent::description() const {
  std::ostringstream text;
  text << "mu = " << coefficient_ << " at pressure " << reference_pressure_ << ", falling";
  return text.str();
}

FrictionLawType pressure_dependent_type() {
  using Kind = TypeParameter::Kind;
  return {
      "pressure dependent",
      "mu (p/p_0)^(e-1) p",
      {friction_coefficient_parameter,
       {"Reference pressure", "0", Kind::number,
        "p_0 > 0. Pressure at which the coefficient is mu. [stress]"},
       {"Pressure exponent", "1", Kind::number, "0 < e <= 1. Exponent of the pressure; 1 is Coulomb's law."}},
      [](const TypeInput &input) {
        const double coefficient = read_friction_coefficient(input);
        const double reference = input.positive("Reference pressure");
        const double exponent = input.number("Pressure exponent");
        if (!(exponent > 0. && exponent <= 1.))
          input.reject("Pressure exponent", "a number > 0 and <= 1");
        return std::make_shared<const PressureDependent>(coefficient, reference, exponent);
      }};
}

} // namespace billet
