// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_SAMPLE_LAWS_H
#define BILLET_TESTS_SAMPLE_LAWS_H

#include "given_values.h"

#include "billet/material/plastic.h"
#include "billet/material/rate_factor.h"

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
inline const LudwikHardening ludwik{90., 292., 0.31};  // Johnson and Cook's copper
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

/// 1 + (rate/reference)^{1/p}.
inline std::shared_ptr<const RateFactor> cowper_symonds(const double reference, const double p) {
  return rate_factor_types()
      .find("Cowper-Symonds")
      ->make(GivenValues({{"Reference rate", reference}, {"Rate exponent", p}}));
}

/// 1 + C ln(1 + rate/reference), which kernels compute lane by lane.
class LogarithmicFactor final : public RateFactor {
public:
  LogarithmicFactor(const double reference, const double factor) : reference_(reference), factor_(factor) {}

  std::string description() const override { return "times a logarithm of the rate"; }
  double value(const double rate) const override { return 1. + factor_ * std::log1p(rate / reference_); }
  double slope(const double rate) const override { return factor_ / (reference_ + rate); }

private:
  double reference_, factor_;
};

template <class Law>
std::shared_ptr<const FlowStress> at_rate(const Law &hardening, std::shared_ptr<const RateFactor> factor) {
  return make_flow_stress(make_hardening(hardening), std::move(factor));
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
