// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/friction/coulomb.h"

#include <sstream>

namespace billet {

FrictionLawType coulomb_type();

std::string Coulomb::description() const {
  std::ostringstream text;
  text << "mu = " << coefficient_;
  return text.str();
}

FrictionPointer make_coulomb(const double coefficient) {
  return coefficient == 0. ? nullptr : std::make_shared<const Coulomb>(coefficient);
}

FrictionLawType coulomb_type() {
  return {{"Coulomb",
           "mu p",
           {friction_coefficient_parameter},
           [](const TypeInput &input) {
             return make_coulomb(input.not_negative(friction_coefficient_parameter.key));
           }},
          friction_coefficient_parameter.key};
}

} // namespace billet
