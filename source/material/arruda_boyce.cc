// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/isochoric_energy.h"

#include <cmath>

namespace billet {

ElasticityType arruda_boyce_type();

namespace {

/// W = M Σ_i C_i/N^{i−1} (I1^i − 3^i), N = L², i from 1 to 5: the series of the eight-chain model
/// (Arruda & Boyce 1993), as powers of I1 − 3.
SharedEnergy make_energy(const TypeInput &input) {
  constexpr std::array<double, 5> C = {1. / 2., 1. / 20., 11. / 1050., 19. / 7000., 519. / 673750.};
  const double mu = input.positive("Chain modulus"), limit = input.positive("Locking stretch");
  if (!(limit > 1.))
    input.reject("Locking stretch", "a number > 1");
  std::vector<double> powers(C.size(), 0.);
  for (std::size_t i = 1; i <= C.size(); ++i) {
    const double factor = mu * C[i - 1] * std::pow(limit, -2. * static_cast<double>(i - 1));
    double binomial = 1.; // of i over k
    for (std::size_t k = 1; k <= i; ++k) {
      binomial *= static_cast<double>(i - k + 1) / static_cast<double>(k);
      powers[k - 1] += factor * binomial * std::pow(3., static_cast<double>(i - k));
    }
  }
  return make_invariant_energy(std::move(powers));
}

} // namespace

ElasticityType arruda_boyce_type() {
  using Kind = TypeParameter::Kind;
  return hyperelastic_type(
      "Arruda-Boyce", "eight chains, to the fifth power of I1, rubber near its limit",
      {{"Chain modulus", "0", Kind::number,
        "M > 0. M (1 + 3/(5 L^2) + 99/(175 L^4) + ...) is the shear modulus. [stress]"},
       {"Locking stretch", "0", Kind::number, "L > 1. Stretch of a chain at which it is straight."}},
      "Chain modulus", &make_energy);
}

} // namespace billet
