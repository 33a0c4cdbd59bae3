// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/law_type.h"

namespace billet {

RegisteredType<SharedLaw> umat_type();
RegisteredType<SharedLaw> vumat_type();

TypeTable<SharedLaw> &law_types() {
  static TypeTable<SharedLaw> types{umat_type(), vumat_type()};
  return types;
}

std::string describe_material(const PointLaw &law) {
  return law_types().find(law.name()) != nullptr ? law.name() : law.description();
}

std::string describe_law(const PointLaw &law) {
  return law_types().find(law.name()) != nullptr ? law.name() : law.name() + ", " + law.description();
}

} // namespace billet
