// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/friction/static_kinetic.h"

#include <sstream>

namespace billet {

FrictionLawType static_kinetic_type();

std::string StaticKinetic::description() const {
  std::ostringstream text;
  text << "mu = " << static_ << " at rest, " << kinetic_ << " when fast";
  return text.str();
}

FrictionLawType static_kinetic_type() {
  using Kind = TypeParameter::Kind;
  return {
      "static-kinetic",
      "mu falls from rest to fast sliding as mu_k + (mu - mu_k) exp(-c v), where v is the slip rate",
      {friction_coefficient_parameter,
       {"Kinetic friction coefficient", "0", Kind::number,
        "0 < mu_k <= mu. Friction coefficient of fast sliding."},
       {"Decay coefficient", "0", Kind::number, "c >= 0. Rate of decay over the slip rate. [time/length]"}},
      [](const TypeInput &input) {
        const double at_rest = read_friction_coefficient(input);
        const std::string key = "Kinetic friction coefficient";
        const double kinetic = input.positive(key);
        if (kinetic > at_rest)
          input.reject(key, "a number not above the friction coefficient");
        return std::make_shared<const StaticKinetic>(at_rest, kinetic,
                                                     input.not_negative("Decay coefficient"));
      }};
}

} // namespace billet
