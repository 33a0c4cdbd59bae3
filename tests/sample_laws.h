// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_SAMPLE_LAWS_H
#define BILLET_TESTS_SAMPLE_LAWS_H

#include "given_values.h"
#include "material/texts.h"
#include "testing.h"

#include "billet/material/elasticity.h"
#include "billet/material/hardening.h"
#include "billet/material/plastic.h"
#include "billet/material/rate_factor.h"

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

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

/// Constants of a registered type, as a scene gives them.
struct SampleConstants {
  std::string type, label;
  std::map<std::string, std::string> values;
};

/// Those of the hardening laws above.
inline const std::vector<SampleConstants> hardening_samples = {
    {"linear", "perfect plasticity", {{"Yield stress", "700"}}},
    {"linear", "linear hardening", {{"Yield stress", "700"}, {"Hardening modulus", "300"}}},
    {"Voce",
     "Voce hardening",
     {{"Yield stress", "450"},
      {"Saturation stress", "715"},
      {"Saturation rate", "16.93"},
      {"Hardening modulus", "129.24"}}},
    {"power law",
     "power law",
     {{"Strength coefficient", "565.3"}, {"Prestrain", "0.0071"}, {"Hardening exponent", "0.259"}}},
    {"power law",
     "steep power law",
     {{"Strength coefficient", "589"}, {"Prestrain", "1e-4"}, {"Hardening exponent", "0.216"}}},
    {"Ludwik",
     "Ludwik",
     {{"Yield stress", "90"}, {"Hardening coefficient", "292"}, {"Hardening exponent", "0.31"}}},
    {"table", "table", {{"Table", "0 : 400, 0.01 : 450, 0.1 : 520, 0.5 : 600"}}}};

/// Those of elasticities that two moduli do not determine: rubber, in N and mm. Mooney's and Treloar's
/// (Ogden 1972), and Yeoh's fits.
inline const std::vector<SampleConstants> elasticity_samples = {
    {"Mooney-Rivlin", "", {{"C10", "0.293"}, {"C01", "0.177"}}},
    {"Yeoh", "", {{"C10", "0.184343"}, {"C20", "-0.0021273"}, {"C30", "4.95955e-5"}}},
    {"Ogden", "", {{"Ogden moduli", "0.63, 0.0012, -0.01"}, {"Ogden exponents", "1.3, 5, -2"}}},
    {"Arruda-Boyce", "", {{"Chain modulus", "0.4"}, {"Locking stretch", "3"}}}};

/// Returns all samples of a registered type. The test fails if there is none: give some above.
inline std::vector<SampleConstants> samples_of(const std::string &type,
                                               const std::vector<SampleConstants> &all) {
  std::vector<SampleConstants> found;
  for (const SampleConstants &sample : all)
    if (sample.type == type)
      found.push_back(sample);
  if (found.empty())
    check("'" + type + "' is registered, but tests/sample_laws.h has no sample constants of it", false);
  return found;
}

/// A registered hardening law as a value.
class SampleHardening {
public:
  explicit SampleHardening(std::shared_ptr<const HardeningLaw> law) : law_(std::move(law)) {}

  std::string description() const { return law_->description(); }
  double stress(const double a) const { return law_->stress(a); }
  double slope(const double a) const { return law_->slope(a); }
  double work(const double a) const { return law_->work(a); }
  bool is_bounded() const { return law_->is_bounded(); }
  LaneHardening lane_form() const { return law_->lane_form(); }

private:
  std::shared_ptr<const HardeningLaw> law_;
};

/// Calls run(name, hardening) for the samples of each registered hardening law. Ludwik's law is nearly
/// vertical where plastic flow begins, which differences and floats resolve only where all points flow:
/// `with_ludwik` says so.
template <class Function> void for_each_hardening(const Function &run, const bool with_ludwik = false) {
  for (const auto &type : hardening_types())
    for (const SampleConstants &sample : samples_of(type.name, hardening_samples))
      if (with_ludwik || type.name != "Ludwik")
        run(sample.label, SampleHardening(type.make(Texts(sample.values))));
}

/// Returns the names of the registered elasticities of metals, which two moduli determine, or of the others.
inline std::vector<std::string> elasticities(const bool are_of_metals) {
  std::vector<std::string> names;
  for (const ElasticityType &type : elasticity_types())
    if ((type.make_law != nullptr) == are_of_metals)
      names.push_back(type.name);
  return names;
}
inline std::vector<std::string> metal_elasticities() { return elasticities(true); }

/// Returns the elastic laws of the other registered elasticities, with their names.
inline std::vector<std::pair<std::string, SharedLaw>> rubber_laws() {
  std::vector<std::pair<std::string, SharedLaw>> laws;
  for (const std::string &name : elasticities(false))
    for (SampleConstants sample : samples_of(name, elasticity_samples)) {
      sample.values.insert({{"Volumetric law", "logarithmic"}, {"Bulk modulus", "20"}});
      laws.emplace_back(name, elasticity_types().find(name)->make(Texts(sample.values))->make_elastic_law());
    }
  return laws;
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
