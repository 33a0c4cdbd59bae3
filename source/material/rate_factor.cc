// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/rate_factor.h"

#include <algorithm>

namespace billet {

RateFactorType cowper_symonds_type();

TypeTable<std::shared_ptr<const RateFactor>> &rate_factor_types() {
  static TypeTable<std::shared_ptr<const RateFactor>> types{
      {"none", "1", {}, [](const TypeInput &) { return nullptr; }}, cowper_symonds_type()};
  return types;
}

RateDependentFlow::RateDependentFlow(std::shared_ptr<const HardeningLaw> hardening,
                                     std::shared_ptr<const RateFactor> factor)
    : hardening_(std::move(hardening)), factor_(std::move(factor)) {}

std::string RateDependentFlow::description() const {
  return hardening_->description() + " " + factor_->description();
}

namespace {

/// Flow stress of a step, σ_y(α) R((α − α_n)/Δt), in the form that solve_consistency() requires.
struct FlowOfStep {
  const HardeningLaw &hardening;
  const RateFactor &factor;
  double alpha_n, dt;

  double rate(const double alpha) const { return (alpha - alpha_n) / dt; }
  double stress(const double alpha) const { return hardening.stress(alpha) * factor.value(rate(alpha)); }
  double slope(const double alpha) const {
    return hardening.slope(alpha) * factor.value(rate(alpha)) +
           hardening.stress(alpha) * factor.slope(rate(alpha)) / dt;
  }
};

} // namespace

PlasticIncrement RateDependentFlow::solve(const double q, const double m, const double alpha_n,
                                          const double dt) const {
  // An infinite slope, as at rest, is replaced with one far above every modulus.
  const double steep = m / std::numeric_limits<double>::epsilon();
  if (!(dt > 0.))
    return {0., steep};
  const FlowOfStep law{*hardening_, *factor_, alpha_n, dt};
  const double delta = q > stress(alpha_n) ? solve_consistency(law, q, m, alpha_n) : 0.;
  return {delta, std::min(steep, law.slope(alpha_n + delta))};
}

void RateDependentFlow::advance(const double alpha_n, const double delta_alpha, const double dt,
                                const State &state_n, State &state) const {
  state[0] = state_n[0] + factor_->value(delta_alpha / dt) *
                              (hardening_->work(alpha_n + delta_alpha) - hardening_->work(alpha_n));
}

std::shared_ptr<const FlowStress> make_flow_stress(std::shared_ptr<const HardeningLaw> hardening,
                                                   std::shared_ptr<const RateFactor> factor) {
  if (factor == nullptr)
    return hardening;
  return std::make_shared<const RateDependentFlow>(std::move(hardening), std::move(factor));
}

} // namespace billet
