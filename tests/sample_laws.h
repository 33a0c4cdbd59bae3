// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_SAMPLE_LAWS_H
#define BILLET_TESTS_SAMPLE_LAWS_H

#include "billet/material/plastic.h"

namespace billet::testing {

// Metals in N and mm.
constexpr double young = 2e5;
constexpr double poisson = 0.3;
inline const ElasticModuli steel = ElasticModuli::from_young_poisson(young, poisson);

inline const LinearHardening perfect{700., 0.};
inline const LinearHardening linear{700., 300.};
inline const VoceHardening voce{450., 715., 16.93, 129.24};     // Simo's necking bar
inline const PowerLawHardening power_law{565.3, 0.0071, 0.259}; // NUMISHEET'93 cup
inline const PowerLawHardening steep_power_law{589., 1e-4,
                                               0.216}; // Wagoner's punch: 80 MPa at first, slope near 3 G
inline const TabulatedHardening table({0., 0.01, 0.1, 0.5}, {400., 450., 520., 600.});

/// Calls run(name, hardening) for one of each.
template <class Function> void for_each_hardening(const Function &run) {
  run("perfect plasticity", perfect);
  run("linear hardening", linear);
  run("Voce hardening", voce);
  run("power law", power_law);
  run("steep power law", steep_power_law);
  run("table", table);
}

/// Δα ≥ 0 with trial − modulus Δα = σ_y(α + Δα), by bisection; 0 where `trial` is below yield.
template <class YieldStress>
double exact_plastic_strain(const YieldStress &yield_stress, const double trial, const double modulus,
                            const double alpha) {
  double low = 0., high = trial > yield_stress(alpha) ? trial / modulus : 0.;
  for (unsigned int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (trial - modulus * middle > yield_stress(alpha + middle) ? low : high) = middle;
  }
  return low;
}

} // namespace billet::testing

#endif
