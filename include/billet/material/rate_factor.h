// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_RATE_FACTOR_H
#define BILLET_MATERIAL_RATE_FACTOR_H

#include "billet/material/hardening.h"

#include <memory>
#include <string>
#include <utility>

namespace billet {

/// Factor of the flow stress as a function of the rate of the equivalent plastic strain [1/time].
class RateFactor {
public:
  virtual ~RateFactor() = default;

  /// Returns a description that follows that of the hardening law, such as "times Cowper and
  /// Symonds' factor of the rate".
  virtual std::string description() const = 0;
  /// Returns the factor, which is 1 at rest and does not decrease.
  virtual double value(double rate) const = 0;
  /// Returns the derivative of value(); it may be infinite at rest [time].
  virtual double slope(double rate) const = 0;
  /// Returns the factor at an equivalent plastic strain, for factors that depend on it, too.
  virtual double value_at(double /*alpha*/, const double rate) const { return value(rate); }
  /// Returns the derivatives of value_at() by the rate [time] and by the plastic strain.
  virtual std::pair<double, double> slopes_at(double /*alpha*/, const double rate) const {
    return {slope(rate), 0.};
  }
  /// Returns the form in which kernels compute it for several elements at once; by default one lane
  /// at a time.
  virtual LaneRate lane_form() const { return {}; }
};

/// Rate factors that a scene file can name; "none" makes a null pointer. A new one is a file in
/// source/material/ with a function that returns its type, and its name in the table of
/// rate_factor.cc.
using RateFactorType = RegisteredType<std::shared_ptr<const RateFactor>>;
TypeTable<std::shared_ptr<const RateFactor>> &rate_factor_types();

/// Hardening times a factor of the rate: the flow stress of a step is σ_y(α_n + Δα) R(Δα/Δt), (M15)
/// of doc/theory.md. Its state is the plastic work, with the factor at the end of the step.
class RateDependentFlow final : public FlowStress {
public:
  RateDependentFlow(std::shared_ptr<const HardeningLaw> hardening, std::shared_ptr<const RateFactor> factor);

  std::string description() const override;
  double stress(double alpha) const override { return hardening_->stress(alpha); }
  PlasticIncrement solve(double q, double m, double alpha_n, double dt) const override;
  std::size_t n_state() const override { return 1; }
  void advance(double alpha_n, double delta_alpha, double dt, const State &state_n,
               State &state) const override;
  double plastic_work(double, const State &state) const override { return state[0]; }
  double plastic_work_at_rest(const double alpha) const override { return hardening_->work(alpha); }
  bool is_bounded() const override { return hardening_->is_bounded(); }
  double slope(double alpha) const override { return hardening_->slope(alpha); }
  /// Returns a form if the factor has one.
  LaneHardening lane_form() const override;

private:
  std::shared_ptr<const HardeningLaw> hardening_;
  std::shared_ptr<const RateFactor> factor_;
};

/// Makes the flow stress; without a factor it is the hardening law itself.
std::shared_ptr<const FlowStress> make_flow_stress(std::shared_ptr<const HardeningLaw> hardening,
                                                   std::shared_ptr<const RateFactor> factor);

} // namespace billet

#endif
