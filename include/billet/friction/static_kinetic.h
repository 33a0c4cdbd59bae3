// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FRICTION_STATIC_KINETIC_H
#define BILLET_FRICTION_STATIC_KINETIC_H

#include "billet/friction/friction_law.h"

#include <cmath>

namespace billet {

/// Friction coefficient that decreases from its static to its kinetic value with the slip rate
/// (Oden & Martins 1985):
///   μ = μ_k + (μ_s − μ_k) exp(−c v),   v the slip rate.
class StaticKinetic final : public FrictionLaw {
public:
  /// μ_s >= μ_k > 0, c >= 0 [time/length]
  StaticKinetic(const double static_coefficient, const double kinetic_coefficient, const double decay)
      : static_(static_coefficient), kinetic_(kinetic_coefficient), decay_(decay) {}

  std::string description() const override;
  double coefficient() const override { return static_; }
  FrictionLimit limit(const double pressure, const double slip_rate) const override {
    const double excess = (static_ - kinetic_) * std::exp(-decay_ * slip_rate);
    const double coefficient = kinetic_ + excess;
    return {coefficient * pressure, coefficient, -decay_ * excess * pressure};
  }

private:
  double static_, kinetic_, decay_;
};

} // namespace billet

#endif
