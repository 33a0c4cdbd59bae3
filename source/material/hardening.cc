// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/hardening.h"

namespace billet {

HardeningType linear_hardening_type();
HardeningType voce_hardening_type();
HardeningType power_law_hardening_type();
HardeningType ludwik_hardening_type();
HardeningType tabulated_hardening_type();

TypeTable<std::shared_ptr<const HardeningLaw>> &hardening_types() {
  static TypeTable<std::shared_ptr<const HardeningLaw>> types{
      linear_hardening_type(), voce_hardening_type(), power_law_hardening_type(), ludwik_hardening_type(),
      tabulated_hardening_type()};
  return types;
}

std::string no_softening(const std::string &allowed) {
  return allowed + ": softening would localise in one layer of elements, and results would depend on the "
                   "mesh, since the law has no internal length";
}

double read_hardening(const TypeInput &input, const std::string &key) {
  if (input.number(key) < 0.)
    input.reject(key, no_softening("a number >= 0"));
  return input.number(key);
}

const TypeParameter yield_stress_parameter{"Yield stress", "0", TypeParameter::Kind::number,
                                           "Sy > 0. Initial yield stress. [stress]"};
const TypeParameter hardening_modulus_parameter{"Hardening modulus", "0", TypeParameter::Kind::number,
                                                "H >= 0. Hardening modulus. [stress]"};

} // namespace billet
