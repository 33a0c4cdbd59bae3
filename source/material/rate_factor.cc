// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/rate_factor.h"

#include <algorithm>

namespace billet {

RateFactorType cowper_symonds_type();
RateFactorType johnson_cook_rate_type();
RateFactorType tabulated_rate_type();
RateFactorType rate_curves_type();

TypeTable<std::shared_ptr<const RateFactor>> &rate_factor_types() {
  static TypeTable<std::shared_ptr<const RateFactor>> types{
      {"none", "1", {}, [](const TypeInput &) { return nullptr; }},
      cowper_symonds_type(),
      johnson_cook_rate_type(),
      tabulated_rate_type(),
      rate_curves_type()};
  return types;
}

RateDependentFlow::RateDependentFlow(std::shared_ptr<const HardeningLaw> hardening,
                                     std::shared_ptr<const RateFactor> factor)
    : hardening_(std::move(hardening)), factor_(std::move(factor)) {}

std::string RateDependentFlow::description() const {
  return hardening_->description() + " " + factor_->description();
}

namespace {

/// Flow stress of a step as a function of Δα, σ_y(α_n + Δα) R(Δα/Δt).
struct FlowOfStep {
  const HardeningLaw &hardening;
  const RateFactor &factor;
  double alpha_n, dt;

  double stress(const double delta) const {
    return hardening.stress(alpha_n + delta) * factor.value_at(alpha_n + delta, delta / dt);
  }
  double slope(const double delta) const {
    const double alpha = alpha_n + delta;
    const auto [by_rate, by_strain] = factor.slopes_at(alpha, delta / dt);
    return hardening.slope(alpha) * factor.value_at(alpha, delta / dt) +
           hardening.stress(alpha) * (by_rate / dt + by_strain);
  }
};

/// Solves q − m Δα − flow stress = 0 for Δα > 0, given the left side at rest, `excess` > 0. In ln
/// Δα the slope at rest is finite. Newton's method approaches the root from above for factors such
/// as a power or a logarithm of the rate. A shrinking bracket safeguards it. It stops at round-off.
double solve_at_rate(const FlowOfStep &law, const double q, const double m, const double excess) {
  double low = std::numeric_limits<double>::min(), high = excess / m, delta = high;
  const double tolerance = 4. * std::numeric_limits<double>::epsilon() * q;
  for (unsigned int i = 0; i < 200; ++i) {
    const double f = q - m * delta - law.stress(delta);
    if (std::abs(f) <= tolerance)
      break;
    (f > 0. ? low : high) = delta;
    double next = delta * std::exp(f / ((m + law.slope(delta)) * delta));
    if (next == delta)
      break;
    if (!(next > low && next < high))
      next = std::sqrt(low) * std::sqrt(high);
    delta = next;
  }
  return delta;
}

} // namespace

PlasticIncrement RateDependentFlow::solve(const double q, const double m, const double alpha_n,
                                          const double dt) const {
  // An infinite slope, as at rest, is replaced with one far above every modulus.
  const double steep = m / std::numeric_limits<double>::epsilon();
  if (!(dt > 0.))
    return {0., steep};
  const FlowOfStep law{*hardening_, *factor_, alpha_n, dt};
  const double excess = q - stress(alpha_n);
  const double delta = excess > 0. ? solve_at_rate(law, q, m, excess) : 0.;
  return {delta, std::min(steep, law.slope(delta))};
}

void RateDependentFlow::advance(const double alpha_n, const double delta_alpha, const double dt,
                                const State &state_n, State &state) const {
  state[0] = state_n[0] + factor_->value_at(alpha_n + delta_alpha, delta_alpha / dt) *
                              (hardening_->work(alpha_n + delta_alpha) - hardening_->work(alpha_n));
}

LaneHardening RateDependentFlow::lane_form() const {
  LaneHardening form = hardening_->lane_form();
  form.rate = factor_->lane_form();
  return form.rate.kind == RateKind::other ? LaneHardening() : form;
}

std::shared_ptr<const FlowStress> make_flow_stress(std::shared_ptr<const HardeningLaw> hardening,
                                                   std::shared_ptr<const RateFactor> factor) {
  if (factor == nullptr)
    return hardening;
  return std::make_shared<const RateDependentFlow>(std::move(hardening), std::move(factor));
}

} // namespace billet
