// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FRICTION_PRESSURE_DEPENDENT_H
#define BILLET_FRICTION_PRESSURE_DEPENDENT_H

#include "billet/friction/friction_law.h"

#include <cmath>

namespace billet {

/// Friction coefficient that decreases with pressure, as for lubricated sheets (Filzek & Groche
/// 2000):
///   μ = μ_0 (p/p_0)^(e − 1),   so that the limit μ p grows as p^e.
class PressureDependent final : public FrictionLaw {
public:
  /// μ_0 > 0 at the reference pressure p_0 > 0 [stress]; 0 < e <= 1, where 1 is Coulomb's law
  PressureDependent(const double coefficient, const double reference_pressure, const double exponent)
      : coefficient_(coefficient), reference_pressure_(reference_pressure), exponent_(exponent) {}

  std::string description() const override;
  double coefficient() const override { return coefficient_; }
  FrictionLimit limit(const double pressure, double) const override {
    if (!(pressure > 0.)) // where the slope is unbounded
      return {0., 0., 0.};
    const double mu = coefficient_ * std::pow(pressure / reference_pressure_, exponent_ - 1.);
    return {mu * pressure, exponent_ * mu, 0.};
  }

private:
  double coefficient_, reference_pressure_, exponent_;
};

} // namespace billet

#endif
