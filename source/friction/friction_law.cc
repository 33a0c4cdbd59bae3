// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/friction/friction_law.h"

namespace billet {

FrictionLawType coulomb_type();
FrictionLawType shear_limited_type();
FrictionLawType static_kinetic_type();
FrictionLawType pressure_dependent_type();

TypeTable<FrictionPointer, FrictionLawType> &friction_law_types() {
  static TypeTable<FrictionPointer, FrictionLawType> types{coulomb_type(), shear_limited_type(),
                                                           static_kinetic_type(), pressure_dependent_type()};
  return types;
}

const TypeParameter friction_coefficient_parameter{
    "Friction coefficient", "0", TypeParameter::Kind::number,
    "mu >= 0. Friction coefficient, at rest or at the reference pressure. 0: no friction."};

double read_friction_coefficient(const TypeInput &input) {
  const std::string &key = friction_coefficient_parameter.key;
  const double coefficient = input.not_negative(key);
  if (coefficient == 0.)
    input.reject(key, "a number > 0, since there is a friction law");
  return coefficient;
}

} // namespace billet
