// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/isochoric_energy.h"

#include <algorithm>

namespace billet {

ElasticityType ogden_type();

/// W = Σ_p M_p/a_p (λ̄_1^{a_p} + λ̄_2^{a_p} + λ̄_3^{a_p} − 3) (Ogden 1972).
ElasticityType ogden_type() {
  using Kind = TypeParameter::Kind;
  constexpr const char *moduli_key = "Ogden moduli", *exponents_key = "Ogden exponents";
  return hyperelastic_type(
      "Ogden", "W = sum M/a (l1^a + l2^a + l3^a - 3) of principal stretches, rubber up to large strains",
      {{moduli_key, "", Kind::text,
        "M of each term, separated by commas. Half of the sum of M a is the shear modulus. [stress]"},
       {exponents_key, "", Kind::text, "a of each term, not 0, separated by commas."}},
      moduli_key, [](const TypeInput &input) {
        std::vector<double> moduli = input.numbers(moduli_key), exponents = input.numbers(exponents_key);
        if (moduli.empty())
          input.reject(moduli_key, "at least one number");
        if (exponents.size() != moduli.size() ||
            std::find(exponents.begin(), exponents.end(), 0.) != exponents.end())
          input.reject(exponents_key, "as many numbers as 'Ogden moduli', none of them 0");
        return make_ogden_energy(std::move(moduli), std::move(exponents));
      });
}

} // namespace billet
