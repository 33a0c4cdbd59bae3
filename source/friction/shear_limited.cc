// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/friction/shear_limited.h"

#include <sstream>

namespace billet {

FrictionLawType shear_limited_type();

std::string ShearLimited::description() const {
  std::ostringstream text;
  text << "mu = " << coefficient_ << " up to " << max_stress_;
  return text.str();
}

FrictionLawType shear_limited_type() {
  using Kind = TypeParameter::Kind;
  return {"shear limited",
          "mu p, up to the maximum shear stress",
          {friction_coefficient_parameter,
           {"Maximum shear stress", "0", Kind::number,
            "> 0. Upper bound of the shear stress at any pressure. [stress]"}},
          [](const TypeInput &input) {
            const double coefficient = read_friction_coefficient(input);
            return std::make_shared<const ShearLimited>(coefficient, input.positive("Maximum shear stress"));
          }};
}

} // namespace billet
