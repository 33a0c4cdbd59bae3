// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/flow_rule.h"

#include "billet/material/flow_rule_plastic.h"
#include "billet/material/law_adapter.h"
#include "billet/material/oriented_law.h"

#include <sstream>
#include <utility>

namespace billet {

namespace {

constexpr const char *moduli_key = "Backstress moduli", *rates_key = "Backstress rates",
                     *fraction_key = "Taylor-Quinney fraction", *heat_key = "Specific heat";

template <bool has_directions, bool is_thermal>
SharedLaw adapt(const std::string &name, const ElasticModuli &elastic, SharedFlow flow,
                const FlowRule &rule) {
  using Law = FlowRulePlasticity<has_directions, is_thermal>;
  return std::make_shared<const LawAdapter<Law>>(name, Law(elastic, std::move(flow), rule));
}

} // namespace

std::string FlowRule::description() const {
  std::ostringstream text;
  text.precision(6);
  if (thermal != nullptr)
    text << " " << thermal->description();
  for (std::size_t j = 0; j < backstress.size(); ++j)
    text << (j == 0 ? ", backstress of " : " + ") << "C " << backstress[j].modulus << ", g "
         << backstress[j].rate;
  if (anisotropy != nullptr)
    text << ", " << anisotropy->description();
  return text.str();
}

std::vector<TypeParameter> FlowRule::backstress_parameters() {
  using Kind = TypeParameter::Kind;
  return {{moduli_key, "", Kind::text,
           "C >= 0 of the terms of kinematic hardening, separated by commas: slopes of the backstress over "
           "plastic strain at the start, in tension. Empty: isotropic hardening alone. [stress]"},
          {rates_key, "", Kind::text,
           "g >= 0 of these terms: the backstress of a term saturates at C/g (Armstrong and Frederick; "
           "several terms: Chaboche). 0: it does not (Prager). Empty: 0 for all."}};
}

std::vector<BackstressTerm> FlowRule::read_backstress(const TypeInput &input) {
  const std::vector<double> moduli =
                                input.is_set(moduli_key) ? input.numbers(moduli_key) : std::vector<double>(),
                            rates =
                                input.is_set(rates_key) ? input.numbers(rates_key) : std::vector<double>();
  if (moduli.size() > max_terms)
    input.reject(moduli_key, "at most " + std::to_string(max_terms) + " numbers");
  if (!rates.empty() && rates.size() != moduli.size())
    input.reject(rates_key,
                 "as many numbers >= 0 as 'Backstress moduli' has, " + std::to_string(moduli.size()));
  std::vector<BackstressTerm> terms;
  for (std::size_t j = 0; j < moduli.size(); ++j) {
    if (!(moduli[j] >= 0.))
      input.reject(moduli_key, "numbers >= 0");
    if (!rates.empty() && !(rates[j] >= 0.))
      input.reject(rates_key, "numbers >= 0");
    terms.push_back({moduli[j], rates.empty() ? 0. : rates[j]});
  }
  return terms;
}

std::vector<TypeParameter> FlowRule::heating_parameters() {
  using Kind = TypeParameter::Kind;
  return {
      {fraction_key, "0", Kind::number,
       "0 to 1, with a thermal factor. Fraction of the plastic work of the flow stress that heats the point, "
       "without conduction. 0: isothermal, at 'Temperature'."},
      {heat_key, "0", Kind::number,
       "> 0 with a Taylor-Quinney fraction: specific heat per mass. [energy/(mass*temperature)]"}};
}

double FlowRule::read_heating(const TypeInput &input, const double density) {
  const double fraction = input.not_negative(fraction_key);
  if (fraction > 1.)
    input.reject(fraction_key, "a number from 0 to 1");
  if (fraction == 0.) {
    if (input.is_set(heat_key))
      input.reject(heat_key, "no value: 'Taylor-Quinney fraction' is 0");
    return 0.;
  }
  const double heat = input.positive(heat_key);
  if (!(density > 0.))
    input.reject("Density", "a number > 0, since plastic work heats the material");
  return fraction / (density * heat);
}

SharedLaw make_hencky_law(const ElasticModuli &elastic, SharedFlow flow, const FlowRule &rule) {
  if (rule.is_plain())
    return make_hencky_law(elastic, std::move(flow));
  if (rule.anisotropy != nullptr && rule.anisotropy->axes.are_cylindrical()) {
    FlowRule in_space = rule;
    in_space.anisotropy =
        std::make_shared<const Anisotropy>(Anisotropy{rule.anisotropy->coefficients, Axes()});
    return orient(make_hencky_law(elastic, std::move(flow), in_space), rule.anisotropy->axes);
  }
  const std::string name = make_hencky_law(elastic)->name();
  const bool has_directions = !rule.backstress.empty() || rule.anisotropy != nullptr;
  if (!has_directions)
    return adapt<false, true>(name, elastic, std::move(flow), rule);
  return rule.thermal != nullptr ? adapt<true, true>(name, elastic, std::move(flow), rule)
                                 : adapt<true, false>(name, elastic, std::move(flow), rule);
}

SharedLaw make_plastic_law(const Elasticity &elasticity, SharedFlow flow, const FlowRule &rule) {
  return rule.is_plain() ? elasticity.make_plastic_law(std::move(flow))
                         : elasticity.make_law_with_rule(std::move(flow), rule);
}

} // namespace billet
